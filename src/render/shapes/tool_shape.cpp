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
constexpr float kTipRadius = 0.005f, kTaperEnd = 0.25f;
constexpr float kRodRadius = 0.009f, kRodFrom = 0.03f, kRodEnd = 0.17f;  // between the tip and the shaft
constexpr float kNeckRadius = 0.0145f;                                   // behind jaws
constexpr float kCollarGap = 1.0f / 30, kCollarLength = 2.0f / 30, kCollarEdge = 1.0f / 240;
constexpr float kShortestShaft = 0.25f;        // of the handle, behind a blade of any length
constexpr float kCollar = 1.08f;               // radius of the collar, over the shaft's
constexpr float kSlimmer = 0.96f;              // radius of the sheath, over the shaft's
constexpr float kJawUnit = 0.7f / 120;         // half the thickness of a jaw
constexpr Color kSheath = {86, 92, 100, 255};  // sRGB: dark insulation, lighter than what is behind the organ
constexpr float kToolQuarterTurn = static_cast<float>(M_PI / 2);

Color colorOf(const ToolKind& kind, uint8_t alpha = 255) {
  return {kind.color[0], kind.color[1], kind.color[2], alpha};
}

/// Returns the metal in front of the sheath: a thin rod behind a tip, or a neck behind jaws. Where tissue meets the
/// shaft it is the capsule that tissue meets. @param from  its start
Profile rodProfile(const StylusConfig& stylus, float from, float taper_end, float shaft_radius, bool jaws) {
  constexpr float kBevel = 1.0f / 1200;
  if (stylus.shaft_contact) {
    const float bevel = std::min(shaft_radius, taper_end - from);
    return Profile()
        .arc(shaft_radius, from + bevel, -kToolQuarterTurn, 0)
        .line(shaft_radius, from + bevel, shaft_radius, taper_end);
  }
  const float end = std::min(std::max(kRodEnd, from + kBevel), taper_end - kBevel);
  const float radius = std::min(jaws ? kNeckRadius : kRodRadius, shaft_radius);
  const float begin = jaws || from >= kRodFrom ? from + kBevel : kRodFrom;
  const float tip = jaws || from >= kRodFrom ? radius : std::min(kTipRadius, shaft_radius);
  Profile rod;
  rod.line(0, from, tip, std::min(from + kBevel, begin));
  if (begin > from + kBevel) rod.line(tip, from + kBevel, radius, begin);
  if (end > begin) rod.line(radius, begin, radius, end);
  return rod.line(radius, std::max(end, begin), shaft_radius, taper_end);
}

/// Adds a shaft: a rod, an insulated sheath and a collar. @param from  its start, in lengths of the shaft
void addShaft(const StylusConfig& stylus, float from, bool jaws, const Color& collar, ToolShape& shape) {
  constexpr float kStep = 1.0f / 120;  // the sheath begins behind a ring of metal
  const Eigen::Affine3f scale(Eigen::Scaling(static_cast<float>(stylus.shaft_length_m)));
  const float shaft_radius = static_cast<float>(shaftRadius(stylus) / stylus.shaft_length_m);
  const float taper_end = std::max(kTaperEnd, from + 2 * kStep), collar_from = taper_end + kCollarGap;
  const float radius = kSlimmer * shaft_radius;
  const Profile ring = rodProfile(stylus, from, taper_end, shaft_radius, jaws)
                           .line(shaft_radius, taper_end, shaft_radius, taper_end + kStep)
                           .line(shaft_radius, taper_end + kStep, radius, taper_end + kStep);
  addLathe(ring, scale, colorOf(kindOf(ToolMode::kNone)), shape);
  const float sheath_end = std::max(1 - radius, taper_end + kStep);
  const Profile sheath =
      Profile().line(radius, taper_end + kStep, radius, sheath_end).arc(radius, sheath_end, 0, kToolQuarterTurn);
  addLathe(sheath, scale, kSheath, shape);
  const float collar_radius = kCollar * shaft_radius, collar_to = collar_from + kCollarLength;
  const Profile band = Profile()
                           .line(radius, collar_from - kCollarEdge, collar_radius, collar_from)
                           .line(collar_radius, collar_from, collar_radius, collar_to)
                           .line(collar_radius, collar_to, radius, collar_to + kCollarEdge);
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
  const bool erases = kind.tip == ToolTip::kCapsule;  // around the shaft, which is drawn within it
  const double acts_m = erases ? 0 : workingLength(stylus, kind);
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

ToolShape toolWithoutFingers(const StylusConfig& stylus, ToolMode mode) {
  const ToolKind& kind = kindOf(mode);
  ToolShape shape;
  const float length = static_cast<float>(stylus.shaft_length_m), start = shaftStart(stylus, kind);
  addShaft(stylus, start, kind.jaws != nullptr, colorOf(kind), shape);
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
