// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/shapes/tool_shape.h"

#include <algorithm>
#include <cmath>

#include "model/scene/tool_kinds.h"
#include "render/shapes/lathe.h"

namespace viscera {

namespace {

using Color = std::array<uint8_t, 4>;

constexpr uint8_t kOutlineAlpha = 150;

constexpr float kShaftLength = kShaftLength_m, kShaftRadius = kShaftRadius_m, kTipRadius = 0.0006f;
constexpr float kTaperEnd = 0.030f;
constexpr float kCollarGap = 0.004f, kCollarLength = 0.008f, kCollarRadius = 0.0036f;
constexpr float kShortestShaft = 0.03f;  // of what is held, behind a blade however long
constexpr float kHinge = 0.014f;         // where the jaws of a grasper meet the shaft
constexpr float kJawSplay = 0.22f;       // of each jaw from the axis [rad]
constexpr float kQuarterTurn = static_cast<float>(M_PI / 2);

Color colorOf(const ToolKind& kind, uint8_t alpha = 255) {
  return {kind.color[0], kind.color[1], kind.color[2], alpha};
}

void addShaft(float from_z, const Color& collar, ToolShape& shape) {
  constexpr float kBevel = 1e-4f;
  const float taper_end = std::max(kTaperEnd, from_z + 2 * kBevel), collar_from = taper_end + kCollarGap;
  const float from_radius = kTipRadius + (kShaftRadius - kTipRadius) * std::min(from_z / kTaperEnd, 1.0f);
  const Profile shaft = Profile()
                            .line(0, from_z, from_radius, from_z + kBevel)
                            .line(from_radius, from_z + kBevel, kShaftRadius, taper_end)
                            .line(kShaftRadius, taper_end, kShaftRadius, kShaftLength - kShaftRadius)
                            .arc(kShaftRadius, kShaftLength - kShaftRadius, 0, kQuarterTurn);
  addLathe(shaft, Eigen::Affine3f::Identity(), colorOf(kindOf(ToolMode::kNone)), shape);
  const Profile ring =
      Profile()
          .line(kShaftRadius, collar_from - 0.001f, kCollarRadius, collar_from)
          .line(kCollarRadius, collar_from, kCollarRadius, collar_from + kCollarLength)
          .line(kCollarRadius, collar_from + kCollarLength, kShaftRadius, collar_from + kCollarLength + 0.001f);
  addLathe(ring, Eigen::Affine3f::Identity(), collar, shape);
}

/// @param splay  of each from the axis [rad]
void addJaws(float hinge, float splay, const Color& color, ToolShape& shape) {
  for (float side : {-1.0f, 1.0f}) {
    Eigen::Affine3f jaw = Eigen::Affine3f::Identity();
    jaw.translate(Vector3f(0, 0, hinge)).rotate(Eigen::AngleAxisf(-side * splay, Vector3f::UnitY()));
    jaw.translate(Vector3f(0, 0, -hinge / 2)).scale(Vector3f(0.0007f, 0.0014f, hinge / 2));
    addLathe(sphereProfile(1), jaw, color, shape);
  }
}

/// A blade is a lathe pressed flat: wide along y, its point at the low end.
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
  const Profile capsule =
      Profile().arc(radius, low, -kQuarterTurn, 0).line(radius, low, radius, high).arc(radius, high, 0, kQuarterTurn);
  addLathe(capsule, Eigen::Affine3f::Identity(), color, shape);
}

/// A bell that opens towards -z, its rim around the tip.
void addCup(float radius, const Color& color, ToolShape& shape) {
  const Profile bell = Profile()
                           .line(0, 0.5f * radius, radius, 0)
                           .line(radius, 0, 0.6f * radius, 0.7f * radius)
                           .line(0.6f * radius, 0.7f * radius, 0, radius);
  addLathe(bell, Eigen::Affine3f::Identity(), color, shape);
}

/// As they are drawn, open.
float halfOpening(const ScissorsConfig& config) {
  return static_cast<float>(config.opening_deg * M_PI / 360);
}

/// Where the shaft begins: behind what acts.
float shaftStart(const StylusConfig& stylus, const ToolKind& kind) {
  if (kind.tip == ToolTip::kJaws) return kHinge;
  if (kind.tip == ToolTip::kScissors)
    return std::min(static_cast<float>(stylus.scissors.blade_length_m), kShaftLength - kShortestShaft);
  if (kind.tip == ToolTip::kApplier)
    return std::min(static_cast<float>(stylus.clip.jaw_length_m), kShaftLength - kShortestShaft);
  if (kind.tip != ToolTip::kBlade) return 0;
  return std::min(static_cast<float>(bladeSpan(stylus.cut).high_m), kShaftLength - kShortestShaft);
}

/// What acts on tissue, in its true size.
void addTip(const StylusConfig& stylus, const ToolKind& kind, ToolShape& shape) {
  const float reach = static_cast<float>(kind.reach_m(stylus));
  const Color color = colorOf(kind);
  switch (kind.tip) {
    case ToolTip::kBare:
      break;
    case ToolTip::kBall:
      addLathe(sphereProfile(reach), Eigen::Affine3f::Identity(), color, shape);
      break;
    case ToolTip::kJaws:
      addJaws(kHinge, kJawSplay, color, shape);
      break;
    case ToolTip::kScissors:
      addJaws(static_cast<float>(stylus.scissors.blade_length_m), halfOpening(stylus.scissors), color, shape);
      break;
    case ToolTip::kApplier:
      addJaws(static_cast<float>(stylus.clip.jaw_length_m),
              static_cast<float>(std::atan2(0.5 * stylus.clip.opening_m, stylus.clip.jaw_length_m)), color, shape);
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

ToolShape toolShape(const StylusConfig& stylus, ToolMode mode) {
  const ToolKind& kind = kindOf(mode);
  ToolShape shape;
  addShaft(shaftStart(stylus, kind), colorOf(kind), shape);
  addTip(stylus, kind, shape);
  shape.solid_indices = shape.indices.size();
  if (kind.does(kHolds)) {
    const float reach = static_cast<float>(kind.reach_m(stylus));
    addLathe(sphereProfile(reach), Eigen::Affine3f::Identity(), colorOf(kind, kOutlineAlpha), shape);
  }
  return shape;
}

}  // namespace viscera
