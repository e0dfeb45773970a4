// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <memory>
#include <utility>

#include "solver/cpu/state/sleep.h"
#include "support/solver_rig.h"

namespace viscera::test {

// A cube with bricks that fall asleep, and tool motions on it, for the tests of sleep on either backend.

constexpr double kSleepSpacing_m = 0.005;
constexpr double kSleepTick_s = 0.005;
constexpr double kSleepDrag_per_s = 60;  // below twice the slowest mode's frequency: it oscillates, and soon settles
constexpr double kSleepSpeed_m_per_s = SolverConfig{}.sleep_speed_m_per_s;

/// Returns a cube of 13 nodes per edge, 4 bricks per edge. It is fixed at the bottom, and soon at rest.
inline Body sleepyCube(Law law = Law::kSprings) {
  Body body = boxBody({12, 12, 12}, kSleepSpacing_m);
  if (law == Law::kNeoHookean) body = ofLaw(body, 0.4);
  body.material.mass_damping_per_s = kSleepDrag_per_s;
  for (uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).z() == 0) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  return body;
}

inline const Vector3d kCorner_m(0, 0, 0.06);
/// Returns a probe at rest, 2 mm deep in the corner. The tip's radius is 6 mm.
inline ToolMotions probeAtCorner() {
  return probeAt(kCorner_m + Vector3d(0, 0, 0.004));
}
inline ToolMotions grabAtCorner() {
  ToolMotions motions = tool(ToolMode::kGrab, kCorner_m, kCorner_m + Vector3d(-0.002, 0, 0));
  motions[0].hold_begins = true;
  return motions;
}
inline ToolMotions holdAtCorner() {
  const Vector3d tip = kCorner_m + Vector3d(-0.002, 0, 0);
  return tool(ToolMode::kGrab, tip, tip);
}
inline ToolMotions letGoAtCorner() {
  ToolMotions motions = holdAtCorner();
  motions[0].mode = ToolMode::kNone;
  motions[0].hold_ended = ToolMode::kGrab;
  return motions;
}
/// Returns a cut along x through the whole width, blade from above, 1 cm of it in the cube.
inline ToolMotions cutTop() {
  return tool(ToolMode::kCut, {-0.02, 0.0275, 0.14}, {0.08, 0.0275, 0.14});
}

struct SleepKind {
  double sleep_speed_m_per_s = kSleepSpeed_m_per_s, gravity_m_per_s2 = 0;
  bool stability_monitor = false, measured_limit = true;
};
inline Scene sleepyScene(const Model& model, const SleepKind& kind = {}) {
  StylusConfig stylus;
  stylus.grab.radius_m = 0.008;
  stylus.cut.blade_length_m = 0.1;
  stylus.cut.blade_side = BladeSide::kAhead;
  Scene scene = sceneFor(model, 1, {stylus}, {0, 0, -kind.gravity_m_per_s2});
  scene.solver.tick_hz = 1 / kSleepTick_s;
  scene.solver.dt_fraction = scene.solver.dt_fraction_strained = 0.75;
  scene.solver.sleep_speed_m_per_s = kind.sleep_speed_m_per_s;
  scene.solver.stability_monitor = kind.stability_monitor;
  scene.solver.measured_limit = kind.measured_limit;
  return scene;
}

/// Steps until nothing is awake. @return number of ticks, at most `most`
template <class Solver>
int settle(Solver& solver, int most = 2000) {
  int ticks = 0;
  for (; ticks < most && (ticks == 0 || solver.awakeBricks() > 0); ++ticks) solver.step(ToolMotions{});
  return ticks;
}

/// Returns the largest distance of a node of the first body between two states [m].
inline double farthestApart_m(const Model& model, const HostState& a, const HostState& b) {
  double largest = 0;
  for (uint32_t slot : model.bodies[0].lattice.active_slots) {
    largest = std::max(largest, (xyz(a.displacement_m[slot]) - xyz(b.displacement_m[slot])).norm());
  }
  return largest;
}

}  // namespace viscera::test
