// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/scene/scene.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "math/memory_for.h"
#include "math/shipped_files.h"
#include "model/scene/feature_rules.h"
#include "model/scene/file_bounds.h"
#include "model/scene/integrators.h"
#include "model/scene/structure_rules.h"
#include "model/scene/whole_scene_fields.h"
#include "model/scene/yaml/yaml_overrides.h"
#include "model/scene/yaml/yaml_reader.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr double kThinnest_m = 1e-5, kLightest_kg_per_m3 = 100;
constexpr double kThickestNeedle = 0.2;  // share of the arc's radius
constexpr double kMostLinks = 4000;      // of a suture: 0.6 ms per substep

bool isRosName(const std::string& name) {
  if (name.empty() || !std::isalpha(static_cast<unsigned char>(name[0]))) return false;
  for (char c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_') return false;
  }
  return true;
}

template <class List>
void requireNames(const std::string& file, const char* list, const List& items) {
  std::set<std::string> seen;
  for (const auto& item : items) {
    if (!isRosName(item.name)) {
      throw SceneError(file + ": name '" + item.name + "' in '" + list +
                       "' must start with a letter and contain only letters, digits and _");
    }
    if (!seen.insert(item.name).second)
      throw SceneError(file + ": name '" + item.name + "' is used twice in '" + list + "'");
  }
}

void requireFixed(const std::string& where, const FixedConfig& fixed) {
  if (fixed.shape == FixedShape::kBox && (fixed.min_m.array() > fixed.max_m.array()).any()) {
    throw SceneError(where + ": 'min_m' must not exceed 'max_m' on any axis");
  }
  if (fixed.shape == FixedShape::kPlane && fixed.normal.norm() == 0)
    throw SceneError(where + ": 'normal' must not be zero");
  if (fixed.shape == FixedShape::kPart && fixed.part.empty()) throw SceneError(where + ": 'part' must name a part");
  if (fixed.shape != FixedShape::kPart && !fixed.part.empty())
    throw SceneError(where + ": 'part' has no effect without 'shape: part'; add it, or remove 'part'");
}

/// Checks that every pixel of a lens has one line of sight, not much farther out than a pinhole's.
void requireLens(const std::string& file, const CameraConfig& camera) {
  if (!camera.distortion.any()) return;
  constexpr int kAcross = 32;  // number of sampled positions along an axis
  const double half_height = std::tan(camera.vertical_fov_deg * M_PI / 360);
  const double half_width = half_height * camera.width_px / camera.height_px;
  for (int i = 0; i <= kAcross; ++i) {
    for (int j = 0; j <= kAcross; ++j) {
      const Eigen::Vector2d shown(half_width * (2.0 * i / kAcross - 1), half_height * (2.0 * j / kAcross - 1));
      const auto seen = undistorted(camera.distortion, shown);
      if (seen && std::abs(seen->x()) <= kFarthestSight * half_width &&
          std::abs(seen->y()) <= kFarthestSight * half_height)
        continue;
      throw SceneError(file + ": camera '" + camera.name +
                       "': 'distortion' must leave every pixel one line of sight, at most " +
                       numberText(kFarthestSight) +
                       " times as far from the image centre as half the image; there is none at column " +
                       numberText(std::round(1.0 * camera.width_px * i / kAcross)) + ", row " +
                       numberText(std::round(1.0 * camera.height_px * j / kAcross)));
    }
  }
}

void requireStableSubstep(const std::string& file, const SolverConfig& solver, const BodyConfig& body) {
  if (solver.substeps > 0) return;  // checked against the lattice once it is known
  const double xi = body.material.stiffness_damping_ratio, largest = stableFraction(solver.integrator, xi);
  if (solver.dt_fraction < largest) return;
  const std::string asked = file + ": solver.dt_fraction = " + numberText(solver.dt_fraction) + " is not stable with ";
  const std::string less = "; it must be less than " + numberText(largest);
  const IntegratorTraits& traits = traitsOf(solver.integrator);
  if (!traits.dashpot_limits) throw SceneError(asked + "integrator " + traits.name + less);
  throw SceneError(asked + "the stiffness_damping_ratio of body '" + body.name + "', " + numberText(xi) + less +
                   ", or stiffness_damping_ratio must be smaller");
}

/// Removes a preset's nu from a network: its springs determine nu.
void leaveOutNuOfPreset(BodyConfig& body) {
  const TissuePreset* preset = tissueNamed(body.material.tissue);
  if (preset && isNetwork(body.structure) && body.material.poisson_ratio == preset->poisson_ratio)
    body.material.poisson_ratio = MaterialConfig{}.poisson_ratio;
}

/// Resolves `toughness_j_per_m2: auto`. @param tissue  its own, or the body's for a part that names none
void takeToughness(const std::string& where, const std::string& tissue, FractureConfig& cut) {
  if (!cut.of_tissue) return;
  const TissuePreset* preset = tissueNamed(tissue);
  if (!preset || !(preset->toughness_j_per_m2 > 0)) {
    throw SceneError(where + ".cut.toughness_j_per_m2: auto needs a tissue with a known toughness (" +
                     tissuesWith(&TissuePreset::toughness_j_per_m2) + "), not " + (preset ? tissue : "none") +
                     "; or set a number");
  }
  cut.toughness_j_per_m2 = preset->toughness_j_per_m2;
}

void takeToughnesses(const std::string& file, BodyConfig& body) {
  const std::string where = file + ": body '" + body.name + "': ";
  takeToughness(where + "material", body.material.tissue, body.material.cut);
  for (size_t i = 0; i < body.parts.size(); ++i) {
    PartConfig& part = body.parts[i];
    takeToughness(where + "parts[" + std::to_string(i) + "]", part.tissue.empty() ? body.material.tissue : part.tissue,
                  part.cut);
  }
}

/// Resolves `stiffening: auto`.
void takeStiffening(const std::string& file, const BodyConfig& body, MaterialConfig& material) {
  if (!material.stiffens_as_tissue) return;
  const TissuePreset* preset = tissueNamed(material.tissue);
  if (!preset || !(preset->stiffening > 0)) {
    throw SceneError(
        file + ": body '" + body.name + "': material.stiffening: auto needs a tissue with a known stiffening (" +
        tissuesWith(&TissuePreset::stiffening) + "), not " + (preset ? material.tissue : "none") + "; or set a number");
  }
  material.stiffening = preset->stiffening;
}

void requireSuture(const std::string& file, const SutureConfig& suture) {
  const std::string where = file + ": suture '" + suture.name + "': ";
  if (suture.radius_m > 0 && suture.radius_m < kThinnest_m)
    throw SceneError(where + "'radius_m' must be 0 or at least " + numberText(kThinnest_m));
  if (suture.density_kg_per_m3 > 0 && suture.density_kg_per_m3 < kLightest_kg_per_m3)
    throw SceneError(where + "'density_kg_per_m3' must be 0 or at least " + numberText(kLightest_kg_per_m3));
  double length_m = 0;
  Vector3d last = suture.position_m;
  for (const SuturePathPoint& position : suture.path) {
    length_m += (position.position_m - last).norm();
    last = position.position_m;
  }
  if (length_m == 0) throw SceneError(where + "'path' must contain a position that differs from 'position_m'");
  if (suture.length_m > 0) length_m = suture.length_m;
  const double links = length_m / suture.spacing_m;
  if (links >= 2 && links <= kMostLinks) return;
  throw SceneError(where + "a length of " + numberText(length_m) + " m and 'spacing_m' " +
                   numberText(suture.spacing_m) + " make " + numberText(std::floor(links)) + " links; 2 .. " +
                   numberText(kMostLinks) + " are accepted");
}

void requireNeedle(const std::string& file, const SutureConfig& suture) {
  const std::string where = file + ": suture '" + suture.name + "': ";
  const NeedleConfig& needle = suture.needle;
  if (needle.arc == NeedleArc::kNone) return;
  if (suture.start != SutureEnd::kFree)
    throw SceneError(where + "'start' must be free, because 'needle.arc' puts a needle there");
  if (needle.wire_radius_m > kThickestNeedle * needle.radius_m)
    throw SceneError(where + "'needle.wire_radius_m' must be at most " + numberText(kThickestNeedle) +
                     " times 'needle.radius_m'");
  if (needle.puncture_n > 0 && needle.cutting_n > needle.puncture_n)
    throw SceneError(where + "'needle.cutting_n' must be at most 'needle.puncture_n'");
}

void requireMark(const std::string& where, const Scene& scene, const MarkConfig& mark) {
  const auto is_named = [&](const BodyConfig& body) { return body.name == mark.body; };
  if (!mark.body.empty() && std::none_of(scene.bodies.begin(), scene.bodies.end(), is_named))
    throw SceneError(where + "'body' must be empty or the name of a body of the scene; found '" + mark.body + "'");
  if (mark.kind == MarkKind::kRing && mark.normal.isZero())
    throw SceneError(where + "'normal' must not be zero for kind ring");
  if (mark.kind != MarkKind::kLine) return;
  double length_m = 0;
  for (size_t i = 1; i < mark.path.size(); ++i)
    length_m += (mark.path[i].position_m - mark.path[i - 1].position_m).norm();
  if (length_m == 0)
    throw SceneError(where + "'path' must contain two or more positions that differ, for kind line; found " +
                     std::to_string(mark.path.size()));
}

void requireAttached(const std::string& where, const char* key, const Scene& scene, const std::string& name) {
  for (const BodyConfig& body : scene.bodies) {
    if (body.name != name) continue;
    if (body.structure != Structure::kLattice)
      throw SceneError(where + "'" + key + "' must name a body of structure lattice; '" + name + "' has another one");
    return;
  }
  throw SceneError(where + "'" + key + "' must be the name of a body of the scene; found '" + name + "'");
}

void requireAttachments(const std::string& file, const Scene& scene) {
  for (size_t i = 0; i < scene.attachments.size(); ++i) {
    const AttachmentConfig& attachment = scene.attachments[i];
    const std::string where = file + ": attachments[" + std::to_string(i) + "]: ";
    requireAttached(where, "body_a", scene, attachment.body_a);
    requireAttached(where, "body_b", scene, attachment.body_b);
    if (attachment.body_a == attachment.body_b)
      throw SceneError(where + "'body_a' and 'body_b' must be different bodies; both are '" + attachment.body_a + "'");
  }
  if (scene.attachments.empty()) return;
  if (scene.collision.enabled)
    throw SceneError(file + ": 'collision.enabled' must be false with 'attachments', as it pushes the bodies apart");
  if (scene.solver.start == SolverStart::kEquilibrium)
    throw SceneError(file + ": 'solver.start' must be rest with 'attachments'; equilibrium is found without them");
}

/// Checks that a stylus in mode needle has a needle to take.
void requireNeedles(const std::string& file, const Scene& scene) {
  for (const SutureConfig& suture : scene.sutures) {
    if (suture.needle.arc != NeedleArc::kNone) return;
  }
  for (const StylusConfig& stylus : scene.styluses) {
    for (const ToolMode mode : {stylus.idle, stylus.button1, stylus.button2}) {
      if (mode == ToolMode::kNeedle)
        throw SceneError(file + ": stylus '" + stylus.name +
                         "' has mode needle, but no suture has a needle; set 'sutures[].needle.arc'");
    }
  }
}

/// Checks what carries a camera.
void requireCarrier(const std::string& file, const Scene& scene, const CameraConfig& camera) {
  const std::string where = file + ": camera '" + camera.name + "': ";
  if (camera.stylus.empty()) {
    if (camera.lens_angle_deg > 0) throw SceneError(where + "'lens_angle_deg' needs 'stylus'");
    return;
  }
  if (!camera.frame.empty()) throw SceneError(where + "'stylus' and 'frame' exclude each other");
  const auto carries = [&](const StylusConfig& stylus) { return stylus.name == camera.stylus; };
  if (std::none_of(scene.styluses.begin(), scene.styluses.end(), carries))
    throw SceneError(where + "'stylus' must be the name of a stylus of the scene; found '" + camera.stylus + "'");
}

/// Checks rules that involve several keys.
void requireConsistent(const std::string& file, const Scene& scene) {
  if (scene.bodies.empty()) throw SceneError(file + ": 'bodies' must contain at least one body");
  requireNames(file, "bodies", scene.bodies);
  requireNames(file, "styluses", scene.styluses);
  requireNames(file, "cameras", scene.cameras);
  requireNames(file, "obstacles", scene.obstacles);
  requireNames(file, "sutures", scene.sutures);
  for (const BodyConfig& body : scene.bodies) {
    if (body.source == TissueSource::kMesh && body.mesh_file.empty()) {
      throw SceneError(file + ": body '" + body.name + "' has source mesh, which needs 'mesh_file'");
    }
    if (body.source == TissueSource::kLabels && body.scan.file.empty()) {
      throw SceneError(file + ": body '" + body.name + "' has source labels, which needs 'scan.file'");
    }
    const std::string fault = structureFault(body);
    if (!fault.empty()) throw SceneError(file + ": body '" + body.name + "': " + fault);
    for (size_t i = 0; i < body.fixed.size(); ++i) {
      requireFixed(file + ": body '" + body.name + "' fixed[" + std::to_string(i) + "]", body.fixed[i]);
    }
  }
  for (const SutureConfig& suture : scene.sutures) {
    requireSuture(file, suture);
    requireNeedle(file, suture);
  }
  requireNeedles(file, scene);
  requireAttachments(file, scene);
  for (size_t i = 0; i < scene.marks.size(); ++i)
    requireMark(file + ": marks[" + std::to_string(i) + "]: ", scene, scene.marks[i]);
  try {
    requireFeatures(scene);
  } catch (const SceneError& error) {
    throw SceneError(file + ": " + error.what());
  }
  if (hasPressure(scene.bodies) && scene.solver.start == SolverStart::kEquilibrium)
    throw SceneError(file + ": 'solver.start' must be rest with 'pressure'; equilibrium is found without it");
  for (const BodyConfig& body : scene.bodies) requireStableSubstep(file, scene.solver, body);
  for (const CameraConfig& camera : scene.cameras) {
    requireLens(file, camera);
    requireCarrier(file, scene, camera);
    const Vector3d sight = camera.target_m - camera.position_m;
    if (sight.cross(camera.up).norm() <= 1e-9 * camera.up.norm()) {
      throw SceneError(
          file + ": camera '" + camera.name +
          "': 'up' must not be zero or parallel to the line of sight, and 'target_m' must differ from 'position_m'");
    }
  }
}

}  // namespace

Overrides meshOverrides(const std::string& mesh_file) {
  if (mesh_file.empty()) return {};
  std::string quoted = "'";
  for (char c : std::filesystem::absolute(mesh_file).string())
    quoted += c == '\'' ? std::string("''") : std::string(1, c);
  std::string extension = std::filesystem::path(mesh_file).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool gltf = extension == ".glb" || extension == ".gltf";  // glTF 2.0: +y is up
  return {"bodies[0].source=mesh", "bodies[0].mesh_file=" + quoted + "'", "bodies[0].centered=true",
          std::string("bodies[0].up_axis=") + (gltf ? "y" : "z")};
}

std::vector<size_t> autoBodies(const Scene& scene) {
  std::vector<size_t> out;
  for (size_t b = 0; b < scene.bodies.size(); ++b) {
    if (scene.bodies[b].auto_spacing && scene.bodies[b].target_nodes == 0) out.push_back(b);
  }
  return out;
}

Scene parseScene(const std::string& yaml, const std::string& name, const Overrides& overrides) {
  YamlSource source{name, {}};
  Scene scene;
  try {
    YAML::Node root = YAML::Load(yaml);
    if (!root.IsMap())
      throw SceneError(name + ": a scene must be a map of keys, at least with 'bodies'; the file contains no map");
    for (const std::string& text : overrides) applyOverride(root, text, source);
    YamlReader::readMap(root, "", source, scene);
  } catch (const YAML::Exception& e) {
    throw SceneError(yamlFault(name, e, yaml));
  }
  for (BodyConfig& body : scene.bodies) {
    leaveOutNuOfPreset(body);
    takeToughnesses(name, body);
    takeStiffening(name, body, body.material);
  }
  requireConsistent(name, scene);
  return scene;
}

Scene loadScene(const std::string& name, const Overrides& overrides) {
  const std::string shipped = shippedFile(name, "scenes");
  const std::string path = shipped.empty() ? name : shipped;
  requireWithinBounds(path);
  const std::string text = textOf(path, "scene");
  Scene scene = memoryFor<SceneError>(path, [&] { return parseScene(text, path, overrides); });
  scene.file = path;
  scene.folder = std::filesystem::path(path).parent_path().string();
  return scene;
}

}  // namespace viscera
