// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/tool_shape.h"

#include <cmath>

#include "render/lathe.h"

namespace viscera {

namespace {

using Color = std::array<uint8_t, 4>;

// Mode colours after Okabe and Ito, told apart by colour-blind people too, and all of them from red tissue.
constexpr Color kSteel = {190, 195, 202, 255};
constexpr Color kProbeColor = {86, 180, 233, 255};
constexpr Color kGrabColor = {0, 178, 130, 255};
constexpr Color kCutColor = {240, 228, 66, 255};
constexpr Color kEraserColor = {214, 126, 184, 255};
constexpr uint8_t kOutlineAlpha = 150;

constexpr float kShaftLength = kShaftLength_m, kShaftRadius = kShaftRadius_m, kTipRadius = 0.0006f;
constexpr float kTaperEnd = 0.030f;
constexpr float kCollarFrom = 0.034f, kCollarTo = 0.042f, kCollarRadius = 0.0036f;
constexpr float kHinge = 0.014f;    // where the jaws of a grasper meet the shaft
constexpr float kJawSplay = 0.22f;  // of each jaw from the axis [rad]
constexpr float kQuarterTurn = static_cast<float>(M_PI / 2);

Color modeColor(ToolMode mode) {
  switch (mode) {
    case ToolMode::kProbe:
      return kProbeColor;
    case ToolMode::kGrab:
      return kGrabColor;
    case ToolMode::kCut:
      return kCutColor;
    case ToolMode::kCutParticles:
      return kEraserColor;
    case ToolMode::kNone:
      break;
  }
  return kSteel;
}

void addShaft(float from_z, const Color& collar, ToolShape& shape) {
  const float from_radius = kTipRadius + (kShaftRadius - kTipRadius) * from_z / kTaperEnd;
  const Profile shaft = Profile()
                            .line(0, from_z, from_radius, from_z + 1e-4f)
                            .line(from_radius, from_z + 1e-4f, kShaftRadius, kTaperEnd)
                            .line(kShaftRadius, kTaperEnd, kShaftRadius, kShaftLength - kShaftRadius)
                            .arc(kShaftRadius, kShaftLength - kShaftRadius, 0, kQuarterTurn);
  addLathe(shaft, Eigen::Affine3f::Identity(), kSteel, shape);
  const Profile ring = Profile()
                           .line(kShaftRadius, kCollarFrom - 0.001f, kCollarRadius, kCollarFrom)
                           .line(kCollarRadius, kCollarFrom, kCollarRadius, kCollarTo)
                           .line(kCollarRadius, kCollarTo, kShaftRadius, kCollarTo + 0.001f);
  addLathe(ring, Eigen::Affine3f::Identity(), collar, shape);
}

void addJaws(ToolShape& shape) {
  for (float side : {-1.0f, 1.0f}) {
    Eigen::Affine3f jaw = Eigen::Affine3f::Identity();
    jaw.translate(Vector3f(0, 0, kHinge)).rotate(Eigen::AngleAxisf(-side * kJawSplay, Vector3f::UnitY()));
    jaw.translate(Vector3f(0, 0, -kHinge / 2)).scale(Vector3f(0.0007f, 0.0014f, kHinge / 2));
    addLathe(sphereProfile(1), jaw, kGrabColor, shape);
  }
}

/// A blade is a lathe pressed flat: wide along y, sharp along z.
void addBlade(float length, ToolShape& shape) {
  constexpr float kFlatness = 0.12f;
  const float point_z = -0.75f * length, widest_z = -0.35f * length;
  const float point_radius = 0.09f * length, widest_radius = 0.12f * length, root_radius = 0.06f * length;
  const Profile outline = Profile()
                              .line(0, -length, point_radius, point_z)
                              .line(point_radius, point_z, widest_radius, widest_z)
                              .line(widest_radius, widest_z, root_radius, 0)
                              .line(root_radius, 0, 0, 0.1f * length);
  addLathe(outline, Eigen::Affine3f(Eigen::Scaling(kFlatness, 1.0f, 1.0f)), kCutColor, shape);
}

void addCapsule(float radius, float length, ToolShape& shape) {
  const Profile capsule =
      Profile().arc(radius, -length, -kQuarterTurn, 0).line(radius, -length, radius, 0).arc(radius, 0, 0, kQuarterTurn);
  addLathe(capsule, Eigen::Affine3f::Identity(), kEraserColor, shape);
}

}  // namespace

ToolShape toolShape(const StylusConfig& stylus, ToolMode mode) {
  ToolShape shape;
  addShaft(mode == ToolMode::kGrab ? kHinge : 0, modeColor(mode), shape);
  const Eigen::Affine3f at_tip = Eigen::Affine3f::Identity();
  if (mode == ToolMode::kProbe) {
    addLathe(sphereProfile(static_cast<float>(stylus.probe_radius_m)), at_tip, kProbeColor, shape);
  } else if (mode == ToolMode::kGrab) {
    addJaws(shape);
  } else if (mode == ToolMode::kCut) {
    addBlade(static_cast<float>(stylus.blade_length_m), shape);
  } else if (mode == ToolMode::kCutParticles) {
    addCapsule(static_cast<float>(stylus.eraser_radius_m), static_cast<float>(stylus.blade_length_m), shape);
  }
  shape.solid_indices = shape.indices.size();
  if (mode == ToolMode::kGrab) {
    const Color outline = {kGrabColor[0], kGrabColor[1], kGrabColor[2], kOutlineAlpha};
    addLathe(sphereProfile(static_cast<float>(stylus.grab_radius_m)), at_tip, outline, shape);
  }
  return shape;
}

}  // namespace viscera
