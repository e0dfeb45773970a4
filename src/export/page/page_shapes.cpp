// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/page/page_shapes.h"

#include <algorithm>
#include <cmath>

#include "model/scene/tool_kinds.h"
#include "render/shapes/obstacle_shape.h"
#include "session/tube_styles.h"
#include "surface/skins/joined_skins.h"
#include "surface/skins/part_colors.h"
#include "viscera/render/camera.h"
#include "viscera/session/tissue_processes.h"

namespace viscera {

namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t kRgb = 0xffffffU;

Json jsonOf(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Json jsonOf(const CameraConfig& camera) {
  const Pose optical = opticalPose(camera);
  const Quaterniond& q = optical.orientation;
  const Intrinsics lens = intrinsics(camera);
  return {{"name", camera.name},
          {"position", jsonOf(optical.position_m)},
          {"orientation", {q.x(), q.y(), q.z(), q.w()}},
          {"target", jsonOf(camera.target_m)},
          {"focal_px", lens.fy},
          {"width", camera.width_px},
          {"height", camera.height_px}};
}

uint32_t packed(const Vector3d& color) {
  uint32_t out = 0;
  for (int c = 0; c < 3; ++c)
    out |= static_cast<uint32_t>(std::lround(255 * std::clamp(color[c], 0.0, 1.0))) << (8 * c);
  return out;
}

}  // namespace

ToolShape triangleShape(const Scene& scene, const PageShape& shape) {
  switch (shape.kind) {
    case PageShape::Kind::kTool:
      return toolWithoutFingers(scene.styluses[shape.index], shape.mode);
    case PageShape::Kind::kFinger:
      return fingerShape(scene.styluses[shape.index], shape.mode);
    default:
      return obstacleShape(scene.obstacles[shape.index]);
  }
}

void putShape(const ToolShape& shape, PageBytes& out) {
  for (const ToolVertex& vertex : shape.vertices) {
    for (const float x : vertex.position_m) out.putFloat(x);
    for (const float x : vertex.normal) out.putFloat(x);
    for (const uint8_t x : vertex.color) out.putByte(x);
  }
  for (const uint32_t index : shape.indices)
    for (int shift = 0; shift < 32; shift += 8) out.putByte(static_cast<uint8_t>(index >> shift));
}

std::vector<PlacedShape> placedShapes(const Session& session, const Frame& now) {
  std::vector<PlacedShape> out;
  for (size_t o = 0; o < now.obstacles.size(); ++o)
    out.push_back({{PageShape::Kind::kObstacle, o, ToolMode::kNone}, now.obstacles[o]});
  const std::vector<StylusConfig>& styluses = session.scene().styluses;
  for (size_t s = 0; s < styluses.size(); ++s) {
    const StylusMotion& motion = now.tools[s];
    if (!motion.present) continue;
    out.push_back({{PageShape::Kind::kTool, s, motion.mode}, motion.to});
    if (!kindOf(motion.mode).jaws) continue;
    for (const Pose& finger : fingerPoses(styluses[s], motion.mode, motion.opens_to_rad))
      out.push_back({{PageShape::Kind::kFinger, s, motion.mode}, motion.to * finger});
  }
  return out;
}

namespace {

/// Returns the name of a kind of tubes in a page.
const char* nameOf(TubeKind kind) {
  switch (kind) {
    case TubeKind::kSuture:
      return "suture";
    case TubeKind::kNeedle:
      return "needle";
    case TubeKind::kClip:
      return "clip";
    case TubeKind::kStrand:
      return "strand";
  }
  return "";
}

}  // namespace

Json sceneJson(const Session& session, const std::vector<TubeStyle>& styles) {
  const Scene& scene = session.scene();
  Json out = {{"name", scene.name}};
  for (const char* list : {"bodies", "styluses", "cameras", "tubes"}) out[list] = Json::array();
  for (const Body& body : session.model().bodies)
    out["bodies"].push_back({{"name", body.name}, {"color", jsonOf(body.color)}});
  for (const StylusConfig& stylus : scene.styluses) out["styluses"].push_back(stylus.name);
  for (const CameraConfig& camera : scene.cameras)
    if (camera.frame.empty() && camera.stylus.empty()) out["cameras"].push_back(jsonOf(camera));
  for (const TubeStyle& style : styles) {
    out["tubes"].push_back({{"part", nameOf(style.part)},
                            {"radius", style.radius_m},
                            {"color", {style.color[0], style.color[1], style.color[2]}}});
  }
  return out;
}

SceneShapes::SceneShapes(const Scene& scene) : styles_(stylesOf(scene)) {}

uint32_t SceneShapes::styleOf(const VisibleTube& tube) const {
  const auto found = std::find_if(styles_.begin(), styles_.end(), [&](const TubeStyle& style) {
    return style.part == tube.part && style.suture == tube.suture;
  });
  return static_cast<uint32_t>(found == styles_.end() ? 0 : found - styles_.begin());
}

VisibleTubes tubesOf(const Session& session, const Frame& now) {
  VisibleTubes out = now.sutures;
  for (size_t t = 0; t < session.scene().sutures.size(); ++t) {
    const std::vector<Vector3d> positions_m = needlePositions(session, t);
    if (!positions_m.empty()) out.push_back({t, TubeKind::kNeedle, positions_m});
  }
  return out;
}

SceneColors::SceneColors(const Model& model) : whole_(joinSkins(model).colors) {}

std::vector<uint32_t> SceneColors::of(const VisibleMesh& skin) const {
  const VisibleTopology& topology = *skin.topology;
  std::vector<uint32_t> out = whole_;
  out.resize(skin.vertices());
  const size_t whole = std::min(whole_.size(), out.size());
  for (const VisiblePatch& patch : topology.patches) {  // vertices that wounds have added
    const Vector3d& body = topology.bodies[patch.body].color;
    const bool is_wall = patch.kind == SurfaceKind::kWound;
    const uint32_t plain = is_wall ? packed(woundColor(body)) | wallAlpha(patch.body) << 24
                                   : packed(body) | skinAlpha(patch.body, false) << 24;
    for (size_t i = 3 * patch.first; i < 3 * (patch.first + patch.count); ++i) {
      if (topology.triangles[i] < whole) continue;
      const size_t triangle = i - i % 3;
      uint32_t color = plain;
      for (size_t c = triangle; c < triangle + 3 && !is_wall; ++c)
        if (topology.triangles[c] < whole) color = whole_[topology.triangles[c]];
      if (out[topology.triangles[i]] == 0 || !is_wall) out[topology.triangles[i]] = color;
    }
  }
  for (size_t v = 0; v < skin.colors.size(); ++v) out[v] = (out[v] & ~kRgb) | (skin.colors[v] & kRgb);
  return out;
}

}  // namespace viscera
