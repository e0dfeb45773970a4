// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <functional>

#include "viscera/session/session.h"

namespace viscera::test {

constexpr double kHalfM = 0.02;  ///< half an edge of the block, which is centred at the origin
constexpr double kProbeRadiusM = 0.008;

inline CameraConfig cameraOf(const std::string& name, double rate_hz = 30) {
  CameraConfig camera;
  camera.name = name;
  camera.position_m = Vector3d(0, -0.15, 0.08);
  camera.width_px = 64;
  camera.height_px = 48;
  camera.rate_hz = rate_hz;
  return camera;
}

/// Returns a soft block of 125 nodes fixed at its bottom, without gravity, with two styluses and one camera.
inline Scene blockScene() {
  Scene scene;
  scene.environment.gravity_m_per_s2 = Vector3d::Zero();
  BodyConfig body;
  body.name = "block";
  body.source = TissueSource::kBox;
  body.box_size_m = Vector3d::Constant(2 * kHalfM);
  body.spacing_m = 0.01;
  FixedConfig bottom;
  bottom.shape = FixedShape::kPlane;
  bottom.point_m = Vector3d(0, 0, -kHalfM);
  body.fixed = {bottom};
  scene.bodies = {body};
  scene.styluses.resize(2);
  scene.styluses[0].name = "left";
  scene.styluses[1].name = "right";
  for (StylusConfig& stylus : scene.styluses) {
    stylus.probe.radius_m = kProbeRadiusM;
    stylus.max_force_rate_n_per_s = 1e6;
  }
  scene.cameras = {cameraOf("eye")};
  return scene;
}

/// Returns the first stylus at a position, pointing down.
inline StylusSamples leftAt(const Vector3d& tip_m, bool button1 = false, bool button2 = false) {
  StylusSamples samples;
  samples[0] = {true, {tip_m, Quaterniond::Identity()}, button1, button2};
  return samples;
}

/// Input of a tick, from the first on.
using StrokesByTick = std::function<StylusSamples(int tick)>;

constexpr int kPressTicks = 15;
/// Returns the probe moving down on the middle of the block's top; it ends 6 mm deep.
inline StylusSamples press(int tick) {
  constexpr double kAboveM = kHalfM + kProbeRadiusM + 0.002, kDeepM = kHalfM + kProbeRadiusM - 0.006;
  const double share = std::min(1.0, static_cast<double>(tick) / kPressTicks);
  return leftAt({0, 0, kAboveM + share * (kDeepM - kAboveM)});
}

constexpr int kCutTicks = 10;
/// Returns the blade, 2 cm long, moving through the upper half of the block along the plane y = 1 mm.
inline StylusSamples cut(int tick) {
  const double share = static_cast<double>(tick) / kCutTicks;
  return leftAt({-0.03 + 0.06 * share, 0.001, kHalfM + 0.001 - 0.02}, false, true);
}

/// Plays a stroke. @returns the last frame of the session
inline Frame play(Session& session, const StrokesByTick& strokes, int ticks, const FrameRequest& outputs = {}) {
  Frame last;
  for (int t = 1; t <= ticks; ++t) last = session.step(strokes(t), outputs);
  return last;
}

/// Returns the surface mesh after one more tick.
inline SurfaceFrame surfaceAfter(Session& session, const StylusSamples& samples) {
  session.drain();
  FrameRequest outputs;
  outputs.surface = true;
  Frame frame = session.step(samples, outputs);
  if (!frame.surface) frame = session.drain();
  return frame.surface ? *frame.surface : SurfaceFrame{};
}

/// Returns the rest positions of the surface meshes of all bodies, as in a surface frame.
inline std::vector<float> restPositions(const Session& session) {
  std::vector<float> out;
  for (const Body& body : session.model().bodies)
    for (const Vector3f& p : body.skin.mesh.positions_m) out.insert(out.end(), {p.x(), p.y(), p.z()});
  return out;
}

}  // namespace viscera::test
