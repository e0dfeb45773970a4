// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/organ/label_mesh.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "math/number_text.h"
#include "model/scan/labels.h"
#include "model/scan/surface_net.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

std::string noteOf(const std::string& path, const LabelVolume& map, const SurfaceNet& net) {
  constexpr double kCm3 = 1e6;
  TextOut out;
  out << path << ": " << map.frame.size.transpose() << " voxels of " << 1000 * map.frame.spacing_m().transpose()
      << " mm;";
  const std::vector<std::string> names = partNames(map.names);
  for (size_t n = 1; n < names.size(); ++n)
    out << (n > 1 ? ", " : " ") << names[n] << ' ' << net.volumeM3(static_cast<uint8_t>(n)) * kCm3 << " cm3";
  return out.str();
}

}  // namespace

TriangleMesh labelMesh(const BodyConfig& config, const std::string& folder, std::vector<std::string>& notes) {
  const ScanConfig& scan = config.scan;
  const std::filesystem::path base(folder);
  const std::string path = (base / scan.file).string();
  LabelOptions options;
  options.labels = scan.labels;
  if (!scan.names_file.empty()) options.names_file = (base / scan.names_file).string();
  options.axes = scan.axes;
  options.transform = scan.transform;
  options.volume = scan.volume;
  options.series = scan.series;
  options.notes = &notes;
  try {
    const LabelVolume map = readLabels(path, options);
    const SurfaceNet net = surfaceNet(map);
    std::vector<uint8_t> all;
    for (size_t n = 1; n < map.names.size(); ++n) all.push_back(static_cast<uint8_t>(n));
    notes.push_back(noteOf(path, map, net));
    TriangleMesh mesh = labelSurfaces(net, map.names, all);
    if (!config.textures) mesh.detail.reset();
    return mesh;
  } catch (const SceneError& error) {
    throw SceneError("body '" + config.name + "': scan: " + error.what());
  }
}

TriangleMesh withoutSharedBorders(const TriangleMesh& mesh) {
  const auto corners = [&](size_t t) {
    std::array<uint32_t, 3> sorted = mesh.triangles[t];
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  };
  std::map<std::array<uint32_t, 3>, int> parts_at;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) ++parts_at[corners(t)];
  constexpr uint32_t kUnused = UINT32_MAX;
  std::vector<uint32_t> number(mesh.positions_m.size(), kUnused);
  TriangleMesh out;
  out.part_names = mesh.part_names;
  out.detail = mesh.detail;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (parts_at.at(corners(t)) > 1) continue;
    std::array<uint32_t, 3> triangle = mesh.triangles[t];
    for (uint32_t& v : triangle) {
      if (number[v] == kUnused) {
        number[v] = static_cast<uint32_t>(out.positions_m.size());
        out.positions_m.push_back(mesh.positions_m[v]);
      }
      v = number[v];
    }
    out.triangles.push_back(triangle);
    out.parts.push_back(mesh.parts[t]);
  }
  return out;
}

}  // namespace viscera
