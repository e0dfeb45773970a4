// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/number_text.h"
#include "tools/anchor_search.h"
#include "tools/stroke_samples.h"
#include "viscera/math/error.h"
#include "viscera/tools/strokes.h"

namespace viscera {

namespace {

/// Returns the distance along the unit direction at which a ray meets a triangle (Moeller and Trumbore), or infinity.
double hitDistance(const Vector3d& from, const Vector3d& direction, const Vector3d& a, const Vector3d& b,
                   const Vector3d& c) {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  constexpr double kBorder = 1e-9;  // share of an edge: rounding must not let a ray slip between two triangles
  const Vector3d ab = b - a, ac = c - a, p = direction.cross(ac);
  const double det = ab.dot(p);
  if (det == 0) return kMiss;
  const Vector3d s = from - a;
  const double u = s.dot(p) / det;
  const Vector3d q = s.cross(ab);
  const double v = direction.dot(q) / det, t = ac.dot(q) / det;
  return u >= -kBorder && v >= -kBorder && u + v <= 1 + kBorder && t > 0 ? t : kMiss;
}

/// First intersection of a ray with a surface.
struct Hit {
  double distance_m = std::numeric_limits<double>::infinity();
  bool is_held = false;  ///< no corner of the triangle can move
};

Hit firstHit(const Model& model, const Vector3d& from, const Vector3d& direction) {
  Hit nearest;
  for (const Body& body : model.bodies) {
    const TriangleMesh& mesh = body.skin.mesh;
    const auto at = [&](uint32_t vertex) { return mesh.positions_m[vertex].cast<double>(); };
    for (const auto& t : mesh.triangles) {
      const double distance_m = hitDistance(from, direction, at(t[0]), at(t[1]), at(t[2]));
      if (distance_m >= nearest.distance_m) continue;
      const bool is_held = std::all_of(t.begin(), t.end(), [&](uint32_t vertex) { return isHeld(body, vertex); });
      nearest = {distance_m, is_held};
    }
  }
  return nearest;
}

std::string pointText(const Vector3d& point_m) {
  const Eigen::IOFormat list(6, Eigen::DontAlignCols, ", ", ", ", "", "", "[", "]");
  TextOut out;
  out << point_m.transpose().format(list);
  return out.str();
}

std::string rayText(const Anchor& anchor) {
  return "from " + pointText(anchor.from_m) + " towards " + pointText(anchor.towards_m);
}

/// Adds the positions where a stroke works on the surface, in its anchor's frame: keys that are not far above it.
void addSpots(const Stroke& stroke, std::vector<Vector3d>& spots_m) {
  constexpr double kNear = 0.2;  // share of the stroke's reach
  double reach_m = 0;
  for (const Stroke::Key& key : stroke.keys) reach_m = std::max(reach_m, key.pose.position_m.norm());
  for (const Stroke::Key& key : stroke.keys)
    if (key.pose.position_m.z() <= kNear * reach_m) spots_m.push_back(key.pose.position_m);
}

bool same(const Anchor& a, const Anchor& b) {
  return a.from_m == b.from_m && a.towards_m == b.towards_m;
}

/// Returns a note if a stroke meets only fixed tissue, else empty.
/// @param frame  of the stroke's anchor   @param above_m  distance above all surfaces, along its z
std::string heldNote(const Stroke& stroke, const Model& model, const Pose& frame, double above_m) {
  std::vector<Vector3d> spots_m = {Vector3d::Zero()};
  addSpots(stroke, spots_m);
  for (Vector3d spot_m : spots_m) {
    spot_m.z() = above_m;
    const Hit hit = firstHit(model, frame * spot_m, frame.orientation * -Vector3d::UnitZ());
    if (std::isfinite(hit.distance_m) && !hit.is_held) return "";
  }
  return "the stroke of stylus '" + stroke.stylus + "', anchored at " + pointText(frame.position_m) +
         " m, meets only fixed tissue, which neither moves nor pushes back. Use another anchor, or fix " +
         "less (bodies[].fixed)";
}

/// Moves anchored strokes to an organ in the place of another. Those with one anchor stay together.
void follow(const OrganFit& fit, const Model& model, std::vector<Stroke>& strokes) {
  for (Stroke& stroke : strokes) {
    if (!stroke.anchor) continue;
    for (Vector3d* point_m : {&stroke.anchor->from_m, &stroke.anchor->towards_m}) *point_m = fit.moved(*point_m);
    for (Stroke::Key& key : stroke.keys) key.pose.position_m *= fit.tool_scale;
  }
  const std::vector<Stroke> aimed = strokes;
  for (Stroke& stroke : strokes) {
    if (!stroke.anchor) continue;
    const Anchor anchor = *stroke.anchor;
    std::vector<Vector3d> spots_m;
    for (const Stroke& other : aimed)
      if (other.anchor && same(*other.anchor, anchor)) addSpots(other, spots_m);
    const Vector3d shift_m = shiftOntoSkin(model, anchor, spots_m);
    stroke.anchor = Anchor{anchor.from_m + shift_m, anchor.towards_m + shift_m};
  }
}

/// Gives keys relative to parts their positions.
void placeKeys(Strokes& strokes, const Model& model) {
  for (Stroke& stroke : strokes.strokes) {
    for (size_t k = 0; k < stroke.keys.size(); ++k) {
      Stroke::Key& key = stroke.keys[k];
      if (!key.at) continue;
      try {
        key.pose.position_m = positionOf(model, *key.at);
      } catch (const Error& error) {
        throw StrokesError((strokes.file.empty() ? "" : strokes.file + ": ") + "stylus '" + stroke.stylus + "', keys[" +
                           std::to_string(k) + "].at: " + error.what());
      }
      key.at.reset();
    }
  }
}

}  // namespace

std::vector<std::string> resolveAnchors(Strokes& strokes, const Model& model, const std::optional<OrganFit>& fit) {
  std::vector<std::string> notes;
  if (fit) follow(*fit, model, strokes.strokes);
  placeKeys(strokes, model);
  for (Stroke& stroke : strokes.strokes) {
    if (!stroke.anchor) continue;
    const Vector3d direction = (stroke.anchor->towards_m - stroke.anchor->from_m).normalized();
    const double distance = firstHit(model, stroke.anchor->from_m, direction).distance_m;
    if (!std::isfinite(distance)) {
      throw StrokesError((strokes.file.empty() ? "" : strokes.file + ": ") + "the anchor of stylus '" + stroke.stylus +
                         "', a ray " + rayText(*stroke.anchor) + " (m), meets no tissue");
    }
    const Pose frame{stroke.anchor->from_m + distance * direction, frameAlong(-direction)};
    const std::string note = heldNote(stroke, model, frame, distance);
    if (!note.empty()) notes.push_back(note);
    for (Stroke::Key& key : stroke.keys) key.pose = frame * key.pose;
    stroke.anchor.reset();
  }
  return notes;
}

std::string strokesYaml(const Strokes& strokes) {
  constexpr int kFileDigits = 9;  // YAML::Emitter formats numbers by the program's locale
  YAML::Emitter out;
  const auto vector = [&out](const char* key, const Vector3d& v) {
    out << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (int axis = 0; axis < 3; ++axis) out << numberText(v[axis], kFileDigits);
    out << YAML::EndSeq;
  };
  out << YAML::BeginMap;
  if (strokes.tick_hz > 0) {
    out << YAML::Key << "tick_hz" << YAML::Value << exactText(strokes.tick_hz) << YAML::Key << "ticks" << YAML::Value
        << std::to_string(strokes.ticks) << YAML::Key << "input_reset" << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const uint64_t tick : strokes.input_reset) out << std::to_string(tick);
    out << YAML::EndSeq;
    const RecordedFrom& from = strokes.recorded;
    if (!from.scene.empty()) {
      out << YAML::Key << "recorded" << YAML::Value << YAML::BeginMap << YAML::Key << "scene" << YAML::Value
          << YAML::DoubleQuoted << from.scene << YAML::Key << "overrides" << YAML::Value << YAML::DoubleQuoted
          << from.overrides;
      if (!from.state_hash.empty())
        out << YAML::Key << "state_hash" << YAML::Value << YAML::DoubleQuoted << from.state_hash;
      out << YAML::EndMap;
    }
  }
  out << YAML::Key << "strokes" << YAML::Value << YAML::BeginSeq;
  for (const Stroke& stroke : strokes.strokes) {
    out << YAML::BeginMap << YAML::Key << "stylus" << YAML::Value << stroke.stylus;
    if (stroke.keys.empty()) {
      std::string lines;
      for (const Stroke::Sample& sample : stroke.samples) lines += sampleLine(sample);
      out << YAML::Key << "samples" << YAML::Value << YAML::Literal << lines << YAML::EndMap;
      continue;
    }
    out << YAML::Key << "keys" << YAML::Value << YAML::BeginSeq;
    for (const Stroke::Key& key : stroke.keys) {
      out << YAML::Flow << YAML::BeginMap << YAML::Key << "t_s" << YAML::Value << numberText(key.time_s, kFileDigits);
      vector("position_m", key.pose.position_m);
      vector("rotation_deg", degreesFromRotation(key.pose.orientation));
      out << YAML::Key << "button1" << YAML::Value << key.button1 << YAML::Key << "button2" << YAML::Value
          << key.button2;
      if (key.jaw_rad >= 0) out << YAML::Key << "jaw_rad" << YAML::Value << numberText(key.jaw_rad, kFileDigits);
      out << YAML::EndMap;
    }
    out << YAML::EndSeq << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::Key << "marks" << YAML::Value << YAML::BeginSeq;
  for (const Mark& mark : strokes.marks) {
    out << YAML::Flow << YAML::BeginMap << YAML::Key << "name" << YAML::Value << mark.name << YAML::Key << "t_s"
        << YAML::Value << numberText(mark.time_s, kFileDigits) << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

}  // namespace viscera
