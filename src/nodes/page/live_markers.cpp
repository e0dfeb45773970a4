// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/page/live_markers.h"

#include <algorithm>
#include <cmath>

#include "export/page/page_bytes.h"
#include "nodes/ros/conversions.h"

namespace viscera::nodes {
namespace {

using visualization_msgs::Marker;

constexpr size_t kMostPoints = 300000;  // of a marker; tools have some thousand
constexpr size_t kMostMarkers = 4096;   // a scene has some hundred
constexpr int32_t kMostForces = 16;     // styluses of a scene, at most
constexpr float kSolid = 0.99F;         // least alpha that is drawn opaque, as in viewer/draw.js

Vector3d toVector(const geometry_msgs::Point& point) {
  return {point.x, point.y, point.z};
}

uint8_t channel(float value) {
  return static_cast<uint8_t>(std::lround(255 * std::clamp(value, 0.0F, 1.0F)));
}

std::array<uint8_t, 3> rgbOf(const std_msgs::ColorRGBA& color) {
  return {channel(color.r), channel(color.g), channel(color.b)};
}

bool isUsable(const Marker& marker) {
  const std_msgs::ColorRGBA& color = marker.color;
  if (!isFinite(fromMessage(marker.pose)) || !std::isfinite(color.r + color.g + color.b + color.a)) return false;
  if (marker.points.size() > kMostPoints || !std::isfinite(marker.scale.x)) return false;
  return std::all_of(marker.points.begin(), marker.points.end(),
                     [](const geometry_msgs::Point& point) { return toVector(point).allFinite(); });
}

/// Returns the data of a shape: triangles without normals, which the viewer shades flat.
std::string shapeOf(const Marker& marker, size_t vertices) {
  PageBytes out;
  for (size_t v = 0; v < vertices; ++v) {
    for (int axis = 0; axis < 3; ++axis) out.putFloat(static_cast<float>(toVector(marker.points[v])[axis]));
    for (int axis = 0; axis < 3; ++axis) out.putFloat(0);
    for (const uint8_t c : rgbOf(marker.color)) out.putByte(c);
    out.putByte(channel(marker.color.a));
  }
  for (uint32_t v = 0; v < vertices; ++v)
    for (int shift = 0; shift < 32; shift += 8) out.putByte(static_cast<uint8_t>(v >> shift));
  return out.text();
}

std::string partName(const std::string& names) {
  if (names == "sutures") return "suture or clip";
  return names == "needles" ? "needle" : "mark on tissue";
}

/// Appends a list of segments: those that go on where the last one ended become one line.
void addSegments(const Marker& marker, std::vector<LiveTube>& out) {
  for (size_t i = 0; i + 1 < marker.points.size(); i += 2) {
    const Vector3d from_m = toVector(marker.points[i]), to_m = toVector(marker.points[i + 1]);
    const std::array<uint8_t, 3> color = rgbOf(i < marker.colors.size() ? marker.colors[i] : marker.color);
    const bool follows = i > 0 && out.back().color == color && out.back().positions_m.back() == from_m;
    if (!follows) out.push_back({partName(marker.ns), marker.scale.x / 2, color, {from_m}});
    out.back().positions_m.push_back(to_m);
  }
}

}  // namespace

bool LiveMarkers::take(const visualization_msgs::MarkerArray& message) {
  bool changed = false;
  for (const Marker& marker : message.markers) {
    if (marker.action == Marker::DELETEALL) {
      clear();
      changed = true;
    } else if (marker.action == Marker::DELETE) {
      const Key key(marker.ns, marker.id);
      changed |= meshes_.erase(key) + lines_.erase(key) + (marker.ns == "forces" ? forces_.erase(marker.id) : 0) > 0;
      if (marker.ns == "preparing") preparing_.clear();
    } else if (isUsable(marker)) {
      changed |= add(marker);
    }
  }
  return changed;
}

/// Adds or replaces a marker. @returns whether what is drawn differs
bool LiveMarkers::add(const Marker& marker) {
  const Key key(marker.ns, marker.id);
  if (meshes_.size() + lines_.size() >= kMostMarkers && meshes_.count(key) + lines_.count(key) == 0) return false;
  if (marker.ns == "preparing") {
    preparing_ = marker.text;
    return false;
  }
  if (marker.type == Marker::TRIANGLE_LIST) return addMesh(key, marker);
  if (marker.type == Marker::LINE_STRIP || marker.type == Marker::LINE_LIST) {
    Marker& line = lines_[key];
    const bool same = line.points == marker.points && line.colors == marker.colors && line.color == marker.color;
    line = marker;
    return !same;
  }
  if (marker.type == Marker::ARROW && marker.points.size() == 2 && marker.id >= 0 && marker.id < kMostForces) {
    const Vector3d tip_m = toVector(marker.points[0]), arrow_m = toVector(marker.points[1]) - tip_m;
    Force& force = forces_[marker.id];
    const bool same = force.tip_m == tip_m && force.arrow_m == arrow_m;
    force = {tip_m, arrow_m};
    return !same;
  }
  return false;
}

bool LiveMarkers::addMesh(const Key& key, const Marker& marker) {
  Mesh& mesh = meshes_[key];
  const bool same = mesh.part && mesh.marker.points == marker.points && mesh.marker.color == marker.color;
  const bool stays = same && mesh.marker.pose == marker.pose && mesh.marker.header.frame_id == marker.header.frame_id;
  mesh.marker = marker;
  if (same) return !stays;
  auto part = std::make_shared<LivePart>();
  part->number = newPart();
  const size_t vertices = marker.points.size() - marker.points.size() % 3;
  part->bytes = liveMessage({{"part", part->number},
                             {"vertices", vertices},
                             {"indices", vertices},
                             {"solid", marker.color.a >= kSolid ? vertices : 0}},
                            shapeOf(marker, vertices));
  mesh.part = std::move(part);
  return true;
}

std::vector<LiveMarkers::Placed> LiveMarkers::placed(const PoseOfFrame& pose_of) const {
  std::vector<Placed> out;
  for (const auto& [key, mesh] : meshes_) {
    const std::optional<Pose> frame = pose_of(mesh.marker.header.frame_id);
    if (frame) out.push_back({mesh.part, *frame * fromMessage(mesh.marker.pose)});
  }
  return out;
}

std::vector<LiveTube> LiveMarkers::tubes() const {
  std::vector<LiveTube> out;
  for (const auto& [key, marker] : lines_) {
    if (marker.type == Marker::LINE_LIST) {
      addSegments(marker, out);
      continue;
    }
    LiveTube& tube = out.emplace_back(LiveTube{partName(marker.ns), marker.scale.x / 2, rgbOf(marker.color), {}});
    for (const geometry_msgs::Point& point : marker.points) tube.positions_m.push_back(toVector(point));
  }
  return out;
}

std::vector<LiveMarkers::Force> LiveMarkers::forces() const {
  std::vector<Force> out(forces_.empty() ? 0 : static_cast<size_t>(forces_.rbegin()->first) + 1);
  for (const auto& [stylus, force] : forces_) out[static_cast<size_t>(stylus)] = force;
  return out;
}

}  // namespace viscera::nodes
