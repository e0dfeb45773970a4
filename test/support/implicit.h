// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "support/random_state.h"
#include "support/solver_rig.h"

namespace viscera::test {

/// Returns a box that is fixed at one end, with a stiffer and heavier part at the other.
inline Body twoPartBody() {
  Body body = boxBody({5, 4, 4}, 0.01);
  body.lattice.part_names = {"wall", "valve"};
  for (uint32_t slot : body.lattice.active_slots) {
    uint16_t& label = body.lattice.cell_labels[slot];
    if (label && body.lattice.nodeAt(slot).x() >= 3) label = 2;
    if (body.lattice.nodeAt(slot).x() == 0) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  body.parts = {{"valve", 60e3, 0.25, 3000}};
  return body;
}

/// Initial states that no gentle simulation reaches.
enum class Abuse { kRandomPositions, kRandomVelocities, kBoth, kOnePoint, kMirrored };
constexpr Abuse kAbuses[] = {Abuse::kRandomPositions, Abuse::kRandomVelocities, Abuse::kBoth, Abuse::kOnePoint,
                             Abuse::kMirrored};

/// Returns a state with positions up to +-10 h and velocities up to 100 m/s.
inline HostState abusedState(const Model& model, Abuse abuse) {
  const Lattice& lattice = model.bodies[0].lattice;
  const bool positions = abuse == Abuse::kRandomPositions || abuse == Abuse::kBoth;
  const bool velocities = abuse == Abuse::kRandomVelocities || abuse == Abuse::kBoth;
  HostState state = randomState(model, positions ? 10 * lattice.spacing_m : 0, velocities ? 100 : 0, 7);
  for (uint32_t slot : lattice.active_slots) {
    const Vector3d x = lattice.restPosition(slot);
    if (abuse == Abuse::kOnePoint) state.displacement_m[slot] = vec4(Vector3d::Constant(0.015) - x);
    if (abuse == Abuse::kMirrored) state.displacement_m[slot] = vec4({-2 * x.x(), 0, 0});
  }
  return state;
}

/// Runs every abused start without gravity and drag: kinetic and elastic energy must stay below 1.01 of the start.
inline void expectEnergyBound(const std::string& backend, Integrator integrator, double fraction, int iterations = 20) {
  constexpr int kTicks = 8;
  constexpr double kAllowed = 0.01;    // of the start: the stability suite's limit
  constexpr double kNothing_j = 1e-9;  // float32 rounding of a body at rest: 1e-7 h in every spring is 1e-14 J
  Body body = boxBody({3, 3, 3}, 0.01);
  body.material.mass_damping_per_s = 0;
  const Model model = modelOf({body});
  const auto solver = makeBackend(backend, model, sceneWith(integrator, model, 1, fraction, iterations));
  for (const Abuse abuse : kAbuses) {
    SCOPED_TRACE(::testing::Message() << "dt " << fraction << " dt_safe, start " << static_cast<int>(abuse));
    const HostState start = abusedState(model, abuse);
    solver->writeState(start);
    const double start_j = energyOf(model, start);
    for (int t = 0; t < kTicks; ++t) {
      solver->step({});
      const HostState state = solver->readState();
      ASSERT_TRUE(isFinite(state)) << "tick " << t;
      ASSERT_LE(energyOf(model, state), start_j + kAllowed * std::abs(start_j) + kNothing_j) << "tick " << t;
    }
    // A bound kept by not moving would prove nothing. (A mirrored box is at rest.)
    if (abuse != Abuse::kMirrored && fraction >= 1) {
      EXPECT_LT(energyOf(model, solver->readState()), 0.5 * start_j);
    }
  }
}

/// A stylus that grips the body's corner and pulls it out, and one that probes the opposite side.
struct PullAndProbe {
  PullAndProbe() {
    StylusConfig grab, probe;
    grab.grab.radius_m = 0.008;
    probe.probe.radius_m = 0.012;
    styluses = {grab, probe};
  }
  /// Returns the motions of a tick, with the held corner at (0, 0, 0) and the probe above the face at `height_m`.
  ToolMotions motions(int tick, double height_m) const {
    const auto at = [](double x, double y, double z) {
      Pose pose;
      pose.position_m = {x, y, z};
      return pose;
    };
    ToolMotions out;
    out[0].mode = ToolMode::kGrab;
    out[0].hold_begins = tick == 0;
    out[0].from = at(-0.001 * tick, 0, 0);
    out[0].to = at(-0.001 * (tick + 1), 0, 0);
    out[1].mode = ToolMode::kProbe;
    out[1].from = at(0.02, 0.02, height_m + 0.012 - 0.001 * tick);
    out[1].to = at(0.02, 0.02, height_m + 0.011 - 0.001 * tick);
    for (StylusMotion& motion : out) motion.present = true;
    return out;
  }
  std::vector<StylusConfig> styluses;
};

/// Compares ticks of pulling and probing with the reference's implicit Euler: displacements and impulses of the tools.
/// @param tolerance  relative to the largest value
inline void expectToolsLikeReference(const std::string& backend, Integrator integrator, int iterations,
                                     double tolerance) {
  constexpr int kTicks = 3, kSubsteps = 2;
  const PullAndProbe tools;
  Body body = boxBody({4, 4, 4}, 0.01);
  for (uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).z() == 0 && body.lattice.nodeAt(slot).x() > 1)
      body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  const Model model = modelOf({body});
  const auto solver =
      makeBackend(backend, model, sceneWith(integrator, model, kSubsteps, 2, iterations, tools.styluses));
  ReferenceOptions options;
  options.integrator = ReferenceIntegrator::kImplicitEuler;
  options.push_speed_m_per_s = pushSpeed(model);
  ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()), options);
  std::array<Vector3d, 2> before;
  for (int t = 0; t < kTicks; ++t) {
    const ToolMotions motions = tools.motions(t, 0.04);
    before = reference.impulse_n_s;
    tickBoth(*solver, reference, tools.styluses, kSubsteps, motions);
  }
  const HostState state = solver->readState();
  EXPECT_LT(relativeError(state.displacement_m, reference.u_m, reference.active), tolerance);
  const layout::TickStats stats = lastStats(*solver);
  EXPECT_GT(stats.grabbed[0], 0u);
  EXPECT_GT(stats.touched[1], 0u);
  for (size_t s = 0; s < 2; ++s) {
    const Vector3d given = reference.impulse_n_s[s] - before[s];
    EXPECT_GT(given.norm(), 0);
    EXPECT_LT((xyz(stats.impulse[s]) - given).norm(), 10 * tolerance * given.norm()) << "stylus " << s;
  }
}

/// Expects the same bits for every group size, and in every run.
inline void expectSameHashForEveryGroupSize(const Model& model, const Scene& scene, const HostState& start,
                                            const std::vector<ToolMotions>& ticks) {
  uint64_t first = 0;
  for (uint32_t group_size : {32u, 64u, 128u, 256u, 64u}) {
    GpuSolver solver(model, scene, {{}, group_size});
    solver.writeState(start);
    for (const ToolMotions& motions : ticks) solver.step(motions);
    const uint64_t hash = stateHash(model, solver.readState());
    if (first == 0) first = hash;
    EXPECT_EQ(hash, first) << "group size " << group_size;
  }
}

/// Expects the same for an implicit integrator, with all features compiled in.
inline void expectSameHashForEveryGroupSize(Integrator integrator) {
  const PullAndProbe tools;
  const Model model = modelOf({boxBody({6, 5, 7}, 0.01)});
  expectSameHashForEveryGroupSize(model, sceneWith(integrator, model, 2, 3, 6, tools.styluses),
                                  randomState(model, 1e-3, 0.5, 11), {tools.motions(0, 0.07), tools.motions(1, 0.07)});
}

}  // namespace viscera::test
