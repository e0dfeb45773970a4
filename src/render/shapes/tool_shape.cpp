// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/shapes/tool_shape.h"

#include <algorithm>
#include <cmath>

#include "model/scene/tool_kinds.h"
#include "render/shapes/jaw_shape.h"
#include "render/shapes/lathe.h"

namespace viscera {

namespace {

using Color = std::array<uint8_t, 4>;

constexpr uint8_t kOutlineAlpha = 150;

// Shares of the shaft's length.
constexpr float kShaftRadius = 0.025f, kTipRadius = 0.005f, kTaperEnd = 0.25f;
constexpr float kRodRadius = 0.009f, kRodFrom = 0.03f, kRodEnd = 0.17f;  // between the tip and the shaft
constexpr float kNeckRadius = 0.0145f;                                   // behind jaws
constexpr float kCollarGap = 1.0f / 30, kCollarLength = 2.0f / 30, kCollarRadius = 0.027f, kCollarEdge = 1.0f / 240;
constexpr float kShortestShaft = 0.25f;        // of the handle, behind a blade of any length
constexpr float kJawUnit = 0.7f / 120;         // half the thickness of a jaw
constexpr Color kSheath = {86, 92, 100, 255};  // sRGB: dark insulation, lighter than what is behind the organ
constexpr float kToolQuarterTurn = static_cast<float>(M_PI / 2);

Color colorOf(const ToolKind& kind, uint8_t alpha = 255) {
  return {kind.color[0], kind.color[1], kind.color[2], alpha};
}

/// Returns the metal in front of the sheath: a thin rod behind a tip, or a neck behind jaws. @param from  its start
Profile rodProfile(float from, float taper_end, bool jaws) {
  constexpr float kBevel = 1.0f / 1200;
  const float end = std::min(std::max(kRodEnd, from + kBevel), taper_end - kBevel);
  const float radius = jaws ? kNeckRadius : kRodRadius;
  const float begin = jaws || from >= kRodFrom ? from + kBevel : kRodFrom;
  const float tip = jaws || from >= kRodFrom ? radius : kTipRadius;
  Profile rod;
  rod.line(0, from, tip, std::min(from + kBevel, begin));
  if (begin > from + kBevel) rod.line(tip, from + kBevel, radius, begin);
  if (end > begin) rod.line(radius, begin, radius, end);
  return rod.line(radius, std::max(end, begin), kShaftRadius, taper_end);
}

/// Adds a shaft: a rod, an insulated sheath and a collar. @param from  its start, in lengths of the shaft
void addShaft(float length_m, float from, bool jaws, const Color& collar, ToolShape& shape) {
  constexpr float kStep = 1.0f / 120, kSlimmer = 0.96f;  // the sheath begins behind a ring of metal
  const Eigen::Affine3f scale(Eigen::Scaling(length_m));
  const float taper_end = std::max(kTaperEnd, from + 2 * kStep), collar_from = taper_end + kCollarGap;
  const Profile ring = rodProfile(from, taper_end, jaws)
                           .line(kShaftRadius, taper_end, kShaftRadius, taper_end + kStep)
                           .line(kShaftRadius, taper_end + kStep, kSlimmer * kShaftRadius, taper_end + kStep);
  addLathe(ring, scale, colorOf(kindOf(ToolMode::kNone)), shape);
  const float radius = kSlimmer * kShaftRadius;
  const Profile sheath =
      Profile().line(radius, taper_end + kStep, radius, 1 - radius).arc(radius, 1 - radius, 0, kToolQuarterTurn);
  addLathe(sheath, scale, kSheath, shape);
  const float collar_to = collar_from + kCollarLength;
  const Profile band = Profile()
                           .line(radius, collar_from - kCollarEdge, kCollarRadius, collar_from)
                           .line(kCollarRadius, collar_from, kCollarRadius, collar_to)
                           .line(kCollarRadius, collar_to, radius, collar_to + kCollarEdge);
  addLathe(band, scale, collar, shape);
}

/// Adds a blade: a lathe pressed flat, wide along y, its point at the low end.
void addBlade(const BladeSpan& span, const Color& color, ToolShape& shape) {
  constexpr float kFlatness = 0.12f;
  const float length = static_cast<float>(span.high_m - span.low_m);
  const Eigen::Translation3f root(0, 0, static_cast<float>(span.high_m));
  const float point_z = -0.75f * length, widest_z = -0.35f * length;
  const float point_radius = 0.09f * length, widest_radius = 0.12f * length, root_radius = 0.06f * length;
  const Profile outline = Profile()
                              .line(0, -length, point_radius, point_z)
                              .line(point_radius, point_z, widest_radius, widest_z)
                              .line(widest_radius, widest_z, root_radius, 0)
                              .line(root_radius, 0, 0, 0.1f * length);
  addLathe(outline, root * Eigen::Affine3f(Eigen::Scaling(kFlatness, 1.0f, 1.0f)), color, shape);
}

void addCapsule(float radius, const BladeSpan& span, const Color& color, ToolShape& shape) {
  const float low = static_cast<float>(span.low_m), high = static_cast<float>(span.high_m);
  const Profile capsule = Profile()
                              .arc(radius, low, -kToolQuarterTurn, 0)
                              .line(radius, low, radius, high)
                              .arc(radius, high, 0, kToolQuarterTurn);
  addLathe(capsule, Eigen::Affine3f::Identity(), color, shape);
}

/// Adds a bell that opens towards -z, its rim around the tip.
void addCup(float radius, const Color& color, ToolShape& shape) {
  const Profile bell = Profile()
                           .line(0, 0.5f * radius, radius, 0)
                           .line(radius, 0, 0.6f * radius, 0.7f * radius)
                           .line(0.6f * radius, 0.7f * radius, 0, radius);
  addLathe(bell, Eigen::Affine3f::Identity(), color, shape);
}

/// Returns where the shaft starts, behind the tip, in lengths of the shaft.
float shaftStart(const StylusConfig& stylus, const ToolKind& kind) {
  const bool is_blade = kind.tip == ToolTip::kBlade;
  const double acts_m = kind.jaws ? kind.jaws(stylus).length_m : is_blade ? bladeSpan(stylus.cut).high_m : 0;
  return std::min(static_cast<float>(acts_m / stylus.shaft_length_m), 1 - kShortestShaft);
}

/// Adds the tip that acts on tissue, in its true size.
void addTip(const StylusConfig& stylus, const ToolKind& kind, ToolShape& shape) {
  const float reach = static_cast<float>(kind.reach_m(stylus));
  const Color color = colorOf(kind);
  switch (kind.tip) {
    case ToolTip::kBare:
    case ToolTip::kJaws:
      break;
    case ToolTip::kBall:
      addLathe(sphereProfile(reach), Eigen::Affine3f::Identity(), color, shape);
      break;
    case ToolTip::kBlade:
      addBlade(bladeSpan(stylus.cut), color, shape);
      break;
    case ToolTip::kCapsule:
      addCapsule(reach, bladeSpan(stylus.cut), color, shape);
      break;
    case ToolTip::kCup:
      addCup(reach, color, shape);
      break;
  }
}

}  // namespace

double shaftRadius(const StylusConfig& stylus) {
  return static_cast<double>(kShaftRadius) * stylus.shaft_length_m;
}

ToolShape toolWithoutFingers(const StylusConfig& stylus, ToolMode mode) {
  const ToolKind& kind = kindOf(mode);
  ToolShape shape;
  const float length = static_cast<float>(stylus.shaft_length_m), start = shaftStart(stylus, kind);
  addShaft(length, start, kind.jaws != nullptr, colorOf(kind), shape);
  if (kind.jaws) addFork(start * length, kJawUnit * length, colorOf(kindOf(ToolMode::kNone)), shape);
  addTip(stylus, kind, shape);
  shape.solid_indices = shape.indices.size();
  if (kind.does(kHolds)) {
    const float reach = static_cast<float>(kind.reach_m(stylus));
    addLathe(sphereProfile(reach), Eigen::Affine3f::Identity(), colorOf(kind, kOutlineAlpha), shape);
  }
  return shape;
}

ToolShape fingerShape(const StylusConfig& stylus, ToolMode mode) {
  const ToolKind& kind = kindOf(mode);
  ToolShape shape;
  if (!kind.jaws) return shape;
  addJaw(kind, static_cast<float>(kind.jaws(stylus).length_m), kJawUnit * static_cast<float>(stylus.shaft_length_m),
         colorOf(kind), shape);
  shape.solid_indices = shape.indices.size();
  return shape;
}

std::array<Pose, 2> fingerPoses(const StylusConfig& stylus, ToolMode mode, double opening_rad) {
  const Vector3d pivot(0, 0, kindOf(mode).jaws ? kindOf(mode).jaws(stylus).length_m : 0);
  const Quaterniond over(Eigen::AngleAxisd(M_PI, Vector3d::UnitZ()));
  const auto finger = [&](double half_rad, const Quaterniond& side) {
    const Quaterniond turn(Eigen::AngleAxisd(half_rad, Vector3d::UnitY()));
    return Pose{pivot - turn * pivot, turn * side};
  };
  return {finger(-0.5 * opening_rad, Quaterniond::Identity()), finger(0.5 * opening_rad, over)};
}

ToolShape toolShape(const StylusConfig& stylus, ToolMode mode, double opening_rad) {
  ToolShape shape = toolWithoutFingers(stylus, mode);
  const ToolShape finger = fingerShape(stylus, mode);
  std::vector<uint32_t> turned;
  for (const Pose& pose : fingerPoses(stylus, mode, opening_rad)) {
    const auto first = static_cast<uint32_t>(shape.vertices.size());
    for (ToolVertex vertex : finger.vertices) {
      Eigen::Map<Vector3f> at(vertex.position_m.data()), normal(vertex.normal.data());
      at = (pose * at.cast<double>()).cast<float>();
      normal = (pose.orientation * normal.cast<double>()).cast<float>();
      shape.vertices.push_back(vertex);
    }
    for (const uint32_t index : finger.indices) turned.push_back(first + index);
  }
  const auto behind_solid = shape.indices.begin() + static_cast<std::ptrdiff_t>(shape.solid_indices);
  shape.indices.insert(behind_solid, turned.begin(), turned.end());
  shape.solid_indices += turned.size();
  return shape;
}

}  // namespace viscera
