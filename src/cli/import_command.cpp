// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <set>

#include "cli/commands.h"
#include "cli/import/draft.h"
#include "cli/import/list_scan.h"
#include "cli/import/one_body.h"
#include "cli/import/preview.h"
#include "cli/import/read_scan.h"
#include "cli/import/sample_strokes.h"
#include "cli/import/stages.h"
#include "math/number_text.h"
#include "math/one_line.h"
#include "model/scan/dicom.h"
#include "model/scan/surface_net.h"
#include "model/scene/tissue_presets.h"
#include "model/scene/tool_size.h"
#include "viscera/layout/limits.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kNodes = 20000;     ///< approximate number of nodes of the largest body
constexpr double kLeastNodes = 500;  ///< least number of nodes of a smaller one; its spacing is reduced to reach it
constexpr double kHeld = 0.2;  ///< share of a surface's vertices that is fixed, from behind: a share of the length of a
                               ///< pointed organ would fix little
constexpr double kFieldOfViewDeg = 28;  ///< vertical field of view of the camera
constexpr double kUsualLength = 0.1;    ///< size of organs for which tools have their usual sizes [m]
constexpr double kLeastSpacing = 1e-5;  ///< least spacing that a scene accepts [m]
constexpr double kCm3 = 1e6;            ///< per cubic metre

/// A body of the scene.
struct Organ {
  std::string name, file, title;
  std::string source, held;  ///< YAML lines of the scene; empty: its mesh file, a plane
  TriangleMesh mesh;
  std::vector<bool> is_held;  ///< [triangles of the mesh]; all or almost all may be fixed
  Eigen::AlignedBox3d box_m;
  double volume_m3 = 0, spacing_m = 0;
  double held_m = 0;  ///< x behind which it is fixed [m]
  bool is_rigid = false;
  size_t skin_faces = 0;                 ///< number of faces that are drawn; 0: all
  const TissuePreset* tissue = nullptr;  ///< preset of the tissue; null: no preset has the label's name
  std::optional<Vector3d> color;         ///< of the label; without: one of a list
};

void printNotes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) std::cout << "note: " << oneLine(note) << '\n';
}

/// Returns a unique name that is valid in file names, YAML and topics.
std::string plainName(const LabelName& label, const std::vector<Organ>& others) {
  std::string name;
  for (const char c : label.name) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  constexpr size_t kLongest = 60;  // limit in bytes
  name.resize(std::min(name.size(), kLongest));
  const auto taken = [&] {
    return std::any_of(others.begin(), others.end(), [&](const Organ& o) { return o.name == name; });
  };
  if (name.empty() || !std::isalpha(static_cast<unsigned char>(name[0]))) {
    name = "label_" + (name.empty() ? std::to_string(label.value) : name);
    std::replace(name.begin(), name.end(), '-', '_');
  }
  const std::string stem = name;
  for (int n = 2; taken(); ++n) name = stem + "_" + std::to_string(n);
  return name;
}

Eigen::AlignedBox3d boxOf(const std::vector<Organ>& organs) {
  Eigen::AlignedBox3d all;
  for (const Organ& organ : organs) all.extend(organ.box_m);
  return all;
}

/// Returns the scale of tools and motions.
double sizeOf(const Eigen::AlignedBox3d& all) {
  return std::cbrt(all.sizes().prod()) / kUsualLength;
}

double heldOf(const TriangleMesh& mesh) {
  std::vector<double> x_m;
  for (const Vector3f& p : mesh.positions_m) x_m.push_back(static_cast<double>(p.x()));
  const auto held = x_m.begin() + static_cast<std::ptrdiff_t>(kHeld * static_cast<double>(x_m.size()));
  std::nth_element(x_m.begin(), held, x_m.end());
  return *held;
}

/// Returns which triangles of a mesh reach behind x.
std::vector<bool> behind(const TriangleMesh& mesh, double x_m) {
  std::vector<bool> out;
  for (const auto& t : mesh.triangles)
    out.push_back(std::any_of(t.begin(), t.end(), [&](uint32_t v) { return mesh.positions_m[v].x() <= x_m; }));
  return out;
}

/// Joins all organs into one, including their common borders.
Organ joined(const std::vector<Organ>& organs) {
  Organ whole;
  whole.name = "organs";
  whole.title = std::to_string(organs.size()) + " labels";
  for (const Organ& organ : organs) {
    const auto before = static_cast<uint32_t>(whole.mesh.positions_m.size());
    const TriangleMesh& mesh = organ.mesh;
    whole.mesh.positions_m.insert(whole.mesh.positions_m.end(), mesh.positions_m.begin(), mesh.positions_m.end());
    for (const auto& t : mesh.triangles) whole.mesh.triangles.push_back({t[0] + before, t[1] + before, t[2] + before});
    whole.is_held.insert(whole.is_held.end(), mesh.triangles.size(), organ.is_rigid);
    whole.box_m.extend(organ.box_m);
    whole.volume_m3 += organ.volume_m3;
  }
  whole.held_m = heldOf(whole.mesh);
  return whole;
}

/// Notes the volume that smoothing removes from a label with pieces one or two voxels thick.
void reportLostVolume(const Organ& organ, double voxels_m3, std::vector<std::string>& notes) {
  constexpr double kMostLost = 0.05;  // share; less for a tube of three voxels
  if (organ.volume_m3 >= (1 - kMostLost) * voxels_m3) return;
  TextOut out;
  out.precision(3);
  out << organ.name << ": its surface encloses " << organ.volume_m3 * kCm3 << " of the " << voxels_m3 * kCm3
      << " cm3 of its voxels; pieces that are one or two voxels thick are rounded off";
  notes.push_back(out.str());
}

/// Returns [labels] the volume of their voxels.
std::vector<double> voxelVolumes(const LabelVolume& map) {
  std::vector<size_t> count(map.names.size());
  for (const uint8_t label : map.labels) ++count[label];
  const double voxel_m3 = std::abs(map.frame.axes.determinant());
  std::vector<double> out;
  for (const size_t voxels : count) out.push_back(voxel_m3 * static_cast<double>(voxels));
  return out;
}

std::vector<Organ> organsOf(const ReadScan& read, const ImportOptions& options, std::vector<std::string>& notes) {
  const LabelVolume& map = read.map;
  const size_t count = map.names.size() - 1;
  if (!options.one_body && count > layout::kMaxBodies)
    throw SceneError(options.scan + ": " + std::to_string(count) + " labels; accepted: a scene has at most " +
                     std::to_string(layout::kMaxBodies) +
                     " bodies. Choose labels with --labels; a grey scan needs --window LOW,HIGH");
  const SurfaceNet net = netOf(read, options.window);
  const std::vector<bool> rigid = rigidLabels(map.names, options);
  std::vector<bool> there(map.names.size(), true);
  std::vector<Organ> organs;
  const std::vector<double> voxels_m3 = voxelVolumes(map);
  double largest_m3 = 0;
  for (size_t n = 1; n <= count; ++n) {
    Organ organ;
    organ.name = plainName(map.names[n], organs);
    organ.tissue = tissueOfLabel(map.names[n].name);
    organ.color = map.names[n].color;
    organ.title = options.by_window ? "values in the window" : "label " + std::to_string(map.names[n].value);
    organ.file = organ.name + ".ply";
    organ.is_rigid = rigid[n];
    organ.mesh = labelSurfaces(net, map.names, {static_cast<uint8_t>(n)});
    if (organ.mesh.triangles.empty()) {  // a scene cannot have an empty mesh
      there[n] = false;
      notes.push_back(organ.title + " is left out: all its voxels belong to other labels");
      continue;
    }
    organ.volume_m3 = signedVolume(organ.mesh);
    if (!options.by_window) reportLostVolume(organ, voxels_m3[n], notes);
    for (const Vector3f& p : organ.mesh.positions_m) organ.box_m.extend(p.cast<double>());
    organ.held_m = heldOf(organ.mesh);
    largest_m3 = std::max(largest_m3, organ.volume_m3);
    organs.push_back(std::move(organ));
  }
  if (options.one_body) {
    Organ whole = joined(organs);
    whole.source = oneBodySource(map.names, there, rigid, options);
    whole.held = heldParts(map.names, there, rigid);
    largest_m3 = whole.volume_m3;
    organs = {whole};
  }
  for (Organ& organ : organs) {
    const double nodes = std::max(kLeastNodes, kNodes * organ.volume_m3 / largest_m3);
    organ.spacing_m =
        options.spacing_m > 0 ? options.spacing_m : std::max(kLeastSpacing, std::cbrt(organ.volume_m3 / nodes));
    const double voxel_m = map.frame.spacing_m().maxCoeff();
    if (organ.spacing_m < voxel_m)
      notes.push_back(organ.name + ": a spacing of " + numberText(organ.spacing_m) +
                      " m is finer than its voxels, of up to " + numberText(voxel_m) +
                      " m; the scan has no more detail");
    if (organ.is_rigid) organ.held_m = organ.box_m.max().x() + organ.spacing_m;  // all of it is fixed
    if (organ.held.empty()) organ.is_held = behind(organ.mesh, organ.held_m + organ.spacing_m);
  }
  return organs;
}

/// Simplifies surfaces that are too fine for drawing and skinning in real time, each by the same share.
void chooseSkins(std::vector<Organ>& organs, std::vector<std::string>& notes) {
  constexpr size_t kMostFaces = 400000, kLeastFaces = 2000;
  size_t faces = 0;
  for (const Organ& organ : organs) faces += organ.mesh.triangles.size();
  if (faces <= kMostFaces) return;
  const double share = static_cast<double>(kMostFaces) / static_cast<double>(faces);
  for (Organ& organ : organs) {
    const auto own = static_cast<size_t>(share * static_cast<double>(organ.mesh.triangles.size()));
    organ.skin_faces = std::max(own, std::min(kLeastFaces, organ.mesh.triangles.size()));
  }
  notes.push_back("the surfaces have " + std::to_string(faces) + " triangles, of which about " +
                  std::to_string(kMostFaces) + " are drawn (bodies[].skin_faces of the scene)");
}

void writeFile(const fs::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  file.close();
  if (!file) throw Error(path.string() + ": cannot be written");
}

std::string plyOf(const TriangleMesh& mesh) {
  TextOut out;
  out << "ply\nformat binary_little_endian 1.0\ncomment metres; x anterior, y left, z up\nelement vertex "
      << mesh.positions_m.size() << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
      << mesh.triangles.size() << "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (const Vector3f& p : mesh.positions_m) out.write(reinterpret_cast<const char*>(p.data()), 3 * sizeof(float));
  for (const std::array<uint32_t, 3>& corners : mesh.triangles) {
    out.put(3);
    out.write(reinterpret_cast<const char*>(corners.data()), 3 * sizeof(uint32_t));
  }
  return out.str();
}

/// Returns the YAML text of the scene. Meshes keep the coordinates of the scan; bodies are moved so that their common
/// centre is the origin. There is no gravity, since the scan shows organs deformed by their weight.
std::string sceneOf(const std::vector<Organ>& organs, const std::string& scan) {
  const Eigen::AlignedBox3d all = boxOf(organs);
  static const std::vector<std::string> kColors = {"[0.62, 0.22, 0.2]",  "[0.76, 0.5, 0.38]", "[0.72, 0.3, 0.36]",
                                                   "[0.78, 0.66, 0.46]", "[0.5, 0.26, 0.34]", "[0.66, 0.4, 0.3]"};
  TextOut out;
  out.precision(6);
  out << "# From the scan " << oneLine(scan)
      << "\n# viscera run scene.yaml --strokes strokes.yaml --out played\nname: import\nenvironment: "
         "{gravity_m_per_s2: [0, 0, 0], scan_origin_m: ["
      << listText(all.center()) << "]}\nbodies:\n";
  for (size_t n = 0; n < organs.size(); ++n) {
    const Organ& organ = organs[n];
    out << "  - name: " << organ.name << "  # " << organ.title << "\n    "
        << (organ.source.empty() ? "source: mesh\n    mesh_file: " + organ.file : organ.source)
        << "\n    spacing_m: " << organ.spacing_m << "\n    position_m: [" << listText(-all.center()) << "]"
        << (organ.skin_faces > 0 ? "\n    skin_faces: " + std::to_string(organ.skin_faces) : "")
        << "\n    color: " << (organ.color ? "[" + listText(*organ.color) + "]" : kColors[n % kColors.size()])
        << "\n    layers: []\n    material: {" << materialOf(organ.tissue) << "}"
        << "\n    fixed:\n";
    if (organ.held.empty())
      out << "      - {shape: plane, point_m: [" << listText({organ.held_m, 0, 0}) << "], normal: [1, 0, 0]}\n";
    out << organ.held;
  }
  StylusConfig stylus;
  stylus.cut.blade_length_m = 0.022;
  stylus = scaledTools(stylus, sizeOf(all));
  out << "styluses:\n";
  for (const char* side : {"left", "right"}) {
    out << "  - {name: " << side
        << ", idle: probe, button1: grab, button2: cut, probe: {radius_m: " << stylus.probe.radius_m
        << "}, grab: {radius_m: " << stylus.grab.radius_m << "}, cut: {blade_length_m: " << stylus.cut.blade_length_m
        << "}, shaft_length_m: " << stylus.shaft_length_m << "}\n";
  }
  // From the front, slightly from the organ's left and from above.
  const double half = kFieldOfViewDeg / 2 * M_PI / 180;
  const double distance = 0.5 * all.sizes().norm() / std::sin(half);
  out << "cameras:\n  - {name: camera, position_m: [" << listText(distance * Vector3d(1, 0.35, 0.3).normalized())
      << "], target_m: [0, 0, 0], vertical_fov_deg: " << kFieldOfViewDeg << "}\n";
  for (const auto& [name, direction, up] : {std::tuple("from_left", Vector3d::UnitY(), "[0, 0, 1]"),
                                            std::tuple("from_above", Vector3d::UnitZ(), "[1, 0, 0]")})
    out << "  - {name: " << name << ", position_m: [" << listText(distance * direction)
        << "], target_m: [0, 0, 0], up: " << up << ", vertical_fov_deg: " << kFieldOfViewDeg
        << ", width_px: 320, height_px: 240, rate_hz: 5}\n";
  return out.str();
}

std::vector<const TriangleMesh*> meshesOf(const std::vector<Organ>& organs) {
  std::vector<const TriangleMesh*> meshes;
  for (const Organ& organ : organs) meshes.push_back(&organ.mesh);
  return meshes;
}

void writeScene(const Draft& draft, const std::vector<Organ>& organs, const std::string& scan) {
  for (const Organ& organ : organs)
    if (!organ.file.empty()) writeFile(draft.file(organ.file), plyOf(organ.mesh));
  writeFile(draft.file("scene.yaml"), sceneOf(organs, scan));
  const auto smaller = [](const Organ& a, const Organ& b) {
    return a.is_rigid != b.is_rigid ? a.is_rigid : a.volume_m3 < b.volume_m3;
  };
  const auto largest = std::max_element(organs.begin(), organs.end(), smaller) - organs.begin();
  const Eigen::AlignedBox3d all = boxOf(organs);
  writeFile(draft.file("strokes.yaml"),
            strokesFor(meshesOf(organs), static_cast<size_t>(largest), organs[static_cast<size_t>(largest)].is_held,
                       -all.center(), sizeOf(all)));
}

}  // namespace

int import(const ImportOptions& asked) {
  ImportOptions options = asked;
  if (std::isnan(options.spacing_m))
    throw Error("--spacing must be a number, 0.00001 .. 10; found nan");  // CLI::Range accepts NaN
  std::vector<std::string> notes;
  options.labels.notes = &notes;
  if (options.list) {
    options.labels.guesses = true;
    listScan(options);
    printNotes(notes);
    return 0;
  }
  Draft draft(options.out);
  Stages stages;
  options.labels.progress = [&stages](double share) { stages.at(share); };
  stages.begin("reading");
  ReadScan read = readScan(options, stages, notes);
  stages.begin("surfaces");
  std::vector<Organ> organs = organsOf(read, options, notes);
  chooseSkins(organs, notes);
  read.map = {};
  stages.begin("scene");
  writeScene(draft, organs, options.scan);
  const Scene scene = loadScene(draft.file("scene.yaml").string());
  if (!options.no_previews) {
    stages.begin("previews");
    std::error_code error;
    fs::create_directory(draft.file("preview"), error);
    writePreviews(draft.file("preview").string(), meshesOf(organs), scene, read.slices, notes);
  }
  const std::string took = stages.end();
  draft.keep();
  printNotes(notes);
  for (const Organ& organ : organs) {
    std::cout << organ.name << ": " << organ.title << ", " << organ.volume_m3 * kCm3 << " cm3, "
              << organ.mesh.triangles.size() << " triangles, spacing " << organ.spacing_m << " m, "
              << (organ.tissue ? std::string("tissue ") + organ.tissue->name : "no known tissue of this name: 10000 Pa")
              << '\n';
  }
  const std::string out = oneLine(options.out);
  std::cout << took << (options.no_previews ? "" : "; look at " + out + "/preview") << "\nrun it: viscera run " << out
            << "/scene.yaml --strokes " << out << "/strokes.yaml --out " << out << "/played\n";
  return 0;
}

}  // namespace viscera::cli
