// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/fitted_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "math/number_text.h"
#include "model/scene/file_bounds.h"
#include "model/scene/tool_size.h"
#include "model/scene/within_ranges.h"
#include "model/scene/yaml/yaml_overrides.h"
#include "model/scene/yaml/yaml_reader.h"
#include "model/shape/organ/tissue.h"
#include "model/shape/organ/unit_question.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

/// List of "key=value" under construction.
class Keys {
 public:
  void set(const std::string& key, double value) { add(key) << value; }
  void set(const std::string& key, const Vector3d& v) {
    add(key) << '[' << v.x() << ", " << v.y() << ", " << v.z() << ']';
  }
  Overrides take() const {
    Overrides out;
    for (const std::ostringstream& text : texts_) out.push_back(text.str());
    return out;
  }

 private:
  std::ostream& add(const std::string& key) {
    constexpr int kDigits = 6;  // readable for people: a millionth of an organ
    std::ostringstream& text = texts_.emplace_back();
    text.imbue(std::locale::classic());
    text.precision(kDigits);
    text << key << '=';
    return text;
  }
  std::vector<std::ostringstream> texts_;
};

std::string item(const std::string& list, size_t i) {
  return list + "[" + std::to_string(i) + "].";
}

/// Maps fixed regions, which are in the frame of their body, in the tissue frame. However a mesh is rotated, it is then
/// fixed where the organ of the scene was.
void followFixed(const OrganFit& fit, const BodyConfig& was, const BodyConfig& is, Keys& keys) {
  const Pose from_body = bodyPose(was), to_body = bodyPose(is).inverse();
  const auto moved = [&](const Vector3d& p) -> Vector3d { return to_body * fit.moved(from_body * p); };
  for (size_t i = 0; i < was.fixed.size(); ++i) {
    const FixedConfig& fixed = was.fixed[i];
    const std::string key = "bodies[0]." + item("fixed", i);
    if (fixed.shape == FixedShape::kPlane) {
      const Vector3d normal = (from_body.orientation * fixed.normal).cwiseQuotient(fit.stretch).normalized();
      keys.set(key + "point_m", moved(fixed.point_m));
      keys.set(key + "normal", to_body.orientation * normal);
    } else if (fixed.shape == FixedShape::kSphere) {
      keys.set(key + "center_m", moved(fixed.center_m));
      keys.set(key + "radius_m", fixed.radius_m * std::cbrt(fit.stretch.prod()));
    } else if (fixed.shape == FixedShape::kBox) {
      Eigen::AlignedBox3d box;
      const Eigen::AlignedBox3d held(fixed.min_m, fixed.max_m);
      for (int c = 0; c < 8; ++c) box.extend(moved(held.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c))));
      keys.set(key + "min_m", box.min());
      keys.set(key + "max_m", box.max());
    }
  }
}

bool hasSpacing(const BodyConfig& body) {
  return !body.auto_spacing && body.target_nodes == 0 && body.spacing_m > 0;
}

/// Returns the factor for a cell size with about as many cells as the scene's organ has: smaller tools still find
/// nodes.
double cellScale(const OrganFit& fit) {
  return std::cbrt(fit.stretch.prod());
}

void followSpacing(const OrganFit& fit, const BodyConfig& was, Keys& keys) {
  if (hasSpacing(was)) keys.set("bodies[0].spacing_m", was.spacing_m * cellScale(fit));
}

ObstacleConfig followed(const OrganFit& fit, ObstacleConfig obstacle) {
  const double scale = fit.stretch.minCoeff();  // nothing grows into the organ
  const bool is_turned = !obstacle.rotation_deg.isZero() || !obstacle.rotation_deg_per_s.isZero();
  obstacle.position_m = fit.moved(obstacle.position_m);
  obstacle.velocity_m_per_s *= scale;
  obstacle.radius_m *= scale;
  obstacle.length_m *= scale;
  obstacle.size_m = obstacle.size_m.cwiseProduct(is_turned ? Vector3d::Constant(scale) : fit.stretch);
  return withinRanges(obstacle);
}

void followObstacles(const OrganFit& fit, const Scene& made, Keys& keys) {
  for (size_t i = 0; i < made.obstacles.size(); ++i) {
    if (!made.obstacles[i].frame.empty()) continue;
    const ObstacleConfig obstacle = followed(fit, made.obstacles[i]);
    const std::string key = item("obstacles", i);
    keys.set(key + "position_m", obstacle.position_m);
    if (!obstacle.velocity_m_per_s.isZero()) keys.set(key + "velocity_m_per_s", obstacle.velocity_m_per_s);
    const bool is_round = obstacle.shape == ObstacleShape::kSphere || obstacle.shape == ObstacleShape::kCapsule;
    if (is_round) keys.set(key + "radius_m", obstacle.radius_m);
    if (obstacle.shape == ObstacleShape::kCapsule) keys.set(key + "length_m", obstacle.length_m);
    if (obstacle.shape == ObstacleShape::kBox) keys.set(key + "size_m", obstacle.size_m);
  }
}

void followSutures(const OrganFit& fit, const Scene& made, Keys& keys) {
  for (size_t i = 0; i < made.sutures.size(); ++i) {
    const std::string key = item("sutures", i);
    keys.set(key + "position_m", fit.moved(made.sutures[i].position_m));
    for (size_t k = 0; k < made.sutures[i].path.size(); ++k)
      keys.set(key + item("path", k) + "position_m", fit.moved(made.sutures[i].path[k].position_m));
  }
}

void followMarks(const OrganFit& fit, const Scene& made, Keys& keys) {
  for (size_t i = 0; i < made.marks.size(); ++i) {
    const std::string key = item("marks", i);
    if (made.marks[i].kind != MarkKind::kLine) keys.set(key + "center_m", fit.moved(made.marks[i].center_m));
    for (size_t k = 0; k < made.marks[i].path.size(); ++k)
      keys.set(key + item("path", k) + "position_m", fit.moved(made.marks[i].path[k].position_m));
  }
}

void followCameras(const OrganFit& fit, const Scene& made, Keys& keys) {
  for (size_t i = 0; i < made.cameras.size(); ++i) {
    if (!made.cameras[i].frame.empty()) continue;
    keys.set(item("cameras", i) + "position_m", fit.viewed(made.cameras[i].position_m));
    keys.set(item("cameras", i) + "target_m", fit.viewed(made.cameras[i].target_m));
  }
}

/// @param is  the body with the keys that the user set
void followTools(const OrganFit& fit, const Scene& made, const BodyConfig& is, Keys& keys) {
  const BodyConfig& was = made.bodies[0];
  const bool is_set = hasSpacing(was) && hasSpacing(is) && is.spacing_m != was.spacing_m;
  const double cells = is_set ? is.spacing_m / was.spacing_m : cellScale(fit);
  for (size_t i = 0; i < made.styluses.size(); ++i) {
    StylusConfig stylus = scaledTools(made.styluses[i], fit.tool_scale, cells);
    for (const ToolSize& size : kToolSizes) keys.set(item("styluses", i) + size.key, size.of(stylus));
    if (stylus.trocar.follows != TrocarMotion::kNone)
      keys.set(item("styluses", i) + "trocar.position_m", fit.viewed(stylus.trocar.position_m));
  }
}

Vector3d sightOf(const Scene& scene) {
  for (const CameraConfig& camera : scene.cameras)
    if (camera.frame.empty()) return camera.target_m - camera.position_m;
  return Vector3d::UnitY();
}

/// Returns the bounding box of the first body's closed surfaces, without open sheets and crumbs. None if the organ
/// cannot be read; making a model of it reports the reason.
std::optional<Eigen::AlignedBox3d> boxOf(const Scene& scene) {
  BodyConfig body = scene.bodies[0];
  body.textures = false;  // shape only
  body.fixed.clear();     // may be those of another body
  try {
    return makeTissue(body, scene.folder)->bounds();
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

/// Rejects a mesh without a unit that is far too large: the next step would be a grid of it.
/// @throws MeshError  it is
void requireLikelyUnit(const Scene& scene, const Eigen::AlignedBox3d& made_m, const Eigen::AlignedBox3d& box_m,
                       const Overrides& own) {
  constexpr double kMostTimes = 20;
  const std::string key = "bodies[0].unit_scale_m";
  for (const std::string& text : own)
    if (text.compare(0, key.size() + 1, key + "=") == 0) return;
  const double usual_m = made_m.sizes().maxCoeff(), times = box_m.sizes().maxCoeff() / usual_m;
  if (!(times > kMostTimes)) return;
  throw MeshError(unitQuestion(scene.bodies[0], box_m.sizes(), usual_m) + " It is " + numberText(times, 3) +
                  " times as wide as the scene's body; if the mesh is in metres and really that large, set " + key +
                  "=1");
}

/// Returns the fit between two organs; none if one of them cannot be read, or the sizes are out of proportion.
/// @throws MeshError  as requireLikelyUnit()
std::optional<OrganFit> fitOf(const Scene& made, const Scene& scene, const Overrides& own) {
  const std::optional<Eigen::AlignedBox3d> from = boxOf(made), to = boxOf(scene);
  if (!from || !to) return std::nullopt;
  requireLikelyUnit(scene, *from, *to, own);
  const OrganFit fit = OrganFit::between(*from, *to, sightOf(made));
  return fit.isSound() ? std::optional<OrganFit>(fit) : std::nullopt;
}

/// Returns the scene of the file without overrides; none if the file needs a mesh.
std::optional<Scene> madeScene(const std::string& path) {
  try {
    return loadScene(path);
  } catch (const SceneError&) {
    return std::nullopt;
  }
}

Overrides joined(Overrides first, const Overrides& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

FittedScene loadFittedScene(const std::string& path, const Overrides& mesh, const Overrides& own) {
  FittedScene out;
  out.overrides = joined(mesh, own);
  out.scene = loadScene(path, out.overrides);
  if (mesh.empty()) return out;
  const std::optional<Scene> made = madeScene(path);
  const std::optional<OrganFit> fit = made ? fitOf(*made, out.scene, own) : std::nullopt;
  if (!fit) return out;
  const bool is_alone = made->bodies.size() == 1;
  Keys keys;
  followFixed(*fit, made->bodies[0], out.scene.bodies[0], keys);
  followSpacing(*fit, made->bodies[0], keys);
  if (is_alone) {
    followObstacles(*fit, *made, keys);
    followSutures(*fit, *made, keys);
    followMarks(*fit, *made, keys);
    followCameras(*fit, *made, keys);
    followTools(*fit, *made, out.scene.bodies[0], keys);
  }
  out.overrides = joined(joined(mesh, keys.take()), own);
  out.scene = loadScene(path, out.overrides);
  if (is_alone) out.scene.fit = fit;
  return out;
}

std::string sceneYaml(const std::string& path, const Overrides& overrides, const std::string& remark) {
  requireWithinBounds(path);
  YamlSource source{path, {}};
  YAML::Node root;
  const std::string text = textOf(path, "scene");
  try {
    root = YAML::Load(text);
    for (const std::string& one : overrides) applyOverride(root, one, source);
  } catch (const YAML::Exception& e) {
    throw SceneError(yamlFault(path, e, text));
  }
  namespace fs = std::filesystem;
  const fs::path folder = fs::absolute(path).parent_path();
  const auto makeAbsolute = [&](YAML::Node map, const char* key) {
    const std::string file = map.IsMap() && map[key] ? map[key].as<std::string>("") : "";
    if (!file.empty()) map[key] = (folder / file).lexically_normal().string();
  };
  for (YAML::Node body : root["bodies"]) {
    for (const char* key : {"mesh_file", "detail_mesh"}) makeAbsolute(body, key);
    for (const char* key : {"file", "names_file"})
      if (body["scan"]) makeAbsolute(body["scan"], key);
  }
  YAML::Emitter out;
  out << root;
  return "# " + remark + "\n" + out.c_str() + "\n";
}

}  // namespace viscera
