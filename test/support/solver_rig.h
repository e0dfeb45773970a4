// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "model/scene/integrators.h"
#include "support/backends.h"
#include "tools/motion_packing.h"

namespace viscera::test {

/// Backend and integrator of a test.
struct SolverUnderTest {
  std::string backend;  ///< one of backendNames()
  Integrator integrator = Integrator::kLeapfrog;
};

/// Returns every integrator on every kind of backend, for INSTANTIATE_TEST_SUITE_P.
inline auto solversUnderTest(const std::vector<Integrator>& integrators) {
  std::vector<SolverUnderTest> out;
  for (const std::string& backend : backendKinds()) {
    for (const Integrator integrator : integrators) out.push_back({backend, integrator});
  }
  return ::testing::ValuesIn(out);
}

/// Returns their names as the last part of a test's name.
inline std::string solverSuffix(const ::testing::TestParamInfo<SolverUnderTest>& info) {
  return backendSuffix({info.param.backend, info.index}) + "_" + traitsOf(info.param.integrator).name;
}

/// One test body for every backend and some integrators. @see solversUnderTest
class OnSolver : public ::testing::WithParamInterface<SolverUnderTest>, public GpuTest {
 protected:
  std::unique_ptr<TissueStepper> make(const Model& model, Scene scene) const {
    scene.solver.integrator = GetParam().integrator;
    scene.solver.iterations = 5;
    return makeBackend(GetParam().backend, model, scene);
  }
};

/// Returns the motion of a stylus that is present.
inline StylusMotion motionOf(ToolMode mode, const Vector3d& from_m, const Vector3d& to_m) {
  StylusMotion out;
  out.mode = mode;
  out.present = true;
  out.from.position_m = from_m;
  out.to.position_m = to_m;
  return out;
}
/// Returns motions of the first stylus alone.
inline ToolMotions tool(ToolMode mode, const Vector3d& from_m, const Vector3d& to_m) {
  return ToolMotions{motionOf(mode, from_m, to_m)};
}

inline bool isFinite(const std::vector<layout::vec4>& values) {
  return std::all_of(values.begin(), values.end(), [](const layout::vec4& v) { return xyz(v).allFinite(); });
}
inline bool isFinite(const HostState& state) {
  return isFinite(state.displacement_m) && isFinite(state.velocity_m_per_s);
}

/// Returns the measurements of the last tick, taking all that are available.
inline layout::TickStats lastStats(TissueStepper& solver) {
  layout::TickStats stats{};
  while (solver.pollStats(stats, true)) {
  }
  return stats;
}

/// Makes one tick of a solver and of the reference, with the actions of tools.
inline void tickBoth(TissueStepper& solver, ReferenceSolver& reference, const std::vector<StylusConfig>& styluses,
                     size_t substeps, const ToolMotions& motions) {
  solver.step(motions);
  const ToolActs acts(styluses, static_cast<double>(substeps) * solver.dt_s());
  reference.markTick();
  acts.beginTick(reference, motions);
  std::vector<layout::ToolMotion> rows;
  interpolateMotions(motions, styluses, static_cast<int>(substeps), rows);
  for (size_t s = 0; s < substeps; ++s) reference.substep({rows[2 * s], rows[2 * s + 1]});
  acts.endTick(reference, motions);
}

/// Compares displacements and velocities relative to the largest value.
inline void expectSameState(const HostState& state, const ReferenceSolver& reference, double displacement,
                            double velocity) {
  EXPECT_LT(relativeError(state.displacement_m, reference.u_m, reference.active), displacement);
  EXPECT_LT(relativeError(state.velocity_m_per_s, reference.v_m_per_s, reference.active), velocity);
}

/// Makes a tick without tools of both from a state, in substeps of the solver's. @return end state of the solver
inline HostState expectSameTick(TissueStepper& solver, ReferenceSolver& reference, const HostState& start,
                                double displacement, double velocity) {
  solver.writeState(start);
  load(reference, start);
  solver.step({});
  for (int s = 0; s < solver.substeps(); ++s) reference.substep();
  HostState end = solver.readState();
  expectSameState(end, reference, displacement, velocity);
  return end;
}

/// Compares positions of verlet_paper within the rounding of absolute positions: up to 2^-24 of each, `roundings` of
/// them per substep. x+ = 2 x - x_prev carries each on as a velocity: over n substeps n (n + 1)/2 of them at worst.
/// @return largest error of a position [m]
inline double expectPositionsRounded(const HostState& end, const ReferenceSolver& reference, double roundings,
                                     int substeps, double dt_s) {
  constexpr double kRounding = 1.0 / (1 << 24);
  double farthest_m = 0, error_m = 0, error_m_per_s = 0;
  for (uint32_t slot : reference.active) {
    farthest_m = std::max(farthest_m, reference.restPosition(slot).cwiseAbs().maxCoeff());
    error_m = std::max(error_m, (xyz(end.displacement_m[slot]) - reference.u_m[slot]).norm());
    error_m_per_s = std::max(error_m_per_s, (xyz(end.velocity_m_per_s[slot]) - reference.v_m_per_s[slot]).norm());
  }
  const double rounding_m = roundings * kRounding * farthest_m;
  EXPECT_LT(error_m, rounding_m * substeps * (substeps + 1) / 2);
  EXPECT_LT(error_m_per_s, rounding_m * substeps / dt_s);
  return error_m;
}

/// Expects the same state hash after a reset and the same ticks.
inline void expectResetRestoresTheHash(TissueStepper& solver, const Model& model, int ticks) {
  const auto run = [&] {
    for (int t = 0; t < ticks; ++t) solver.step({});
    return stateHash(model, solver.readState());
  };
  const uint64_t rest = stateHash(model, solver.readState());
  const uint64_t first = run();
  EXPECT_NE(first, rest);
  solver.reset();
  EXPECT_EQ(stateHash(model, solver.readState()), rest);
  EXPECT_EQ(run(), first);
}

/// Moves a stylus that holds something to a non-finite position for a tick: the stability monitor rolls that tick back.
/// @param solver  of a scene with stability monitor and a stylus
inline void expectNoPlaceIsRolledBack(TissueStepper& solver, const Model& model) {
  ToolMotions motions = tool(ToolMode::kGrab, Vector3d::Zero(), Vector3d::Zero());
  motions[0].hold_begins = true;
  solver.step(motions);
  const uint64_t before = stateHash(model, solver.readState());
  motions[0].hold_begins = false;
  motions[0].to.position_m.x() = std::numeric_limits<double>::quiet_NaN();
  solver.step(motions);
  EXPECT_EQ(stateHash(model, solver.readState()), before);
  for (int t = 0; t < 10; ++t) solver.step({});
  EXPECT_EQ(solver.health().trips, 1u);  // a GPU reports it a tick later
  EXPECT_TRUE(isFinite(solver.readState()));
}

/// Returns a blade and tools of some centimetres, for bodies of that size.
inline StylusConfig wideTools() {
  StylusConfig config;
  config.probe.radius_m = config.grab.radius_m = 0.012;
  config.grab.release_speed_m_per_s = 0.05;
  config.cut.blade_length_m = 0.2;
  config.cut.blade_side = BladeSide::kAhead;
  config.cut_particles.eraser_radius_m = 0.004;
  return config;
}

/// A solver and the reference in parallel, under the same two styluses.
class BesideReference : public OnBackend {
 protected:
  BesideReference(size_t substeps, const StylusConfig& both) : substeps_(substeps), styluses_{both, both} {}
  void use(Model model) {
    model_ = std::move(model);
    solver_ = make(model_, sceneFor(model_, static_cast<int>(substeps_), styluses_));
    renewReference();
  }
  void renewReference() {
    ReferenceOptions options;
    options.push_speed_m_per_s = pushSpeed(model_);
    reference_.emplace(model_, Vector3d::Zero(), static_cast<float>(solver_->dt_s()), options);
  }
  void reset() {
    solver_->reset();
    renewReference();
  }
  void write(const HostState& state) {
    solver_->writeState(state);
    load(*reference_, state);
  }
  void tick(const ToolMotions& motions) { tickBoth(*solver_, *reference_, styluses_, substeps_, motions); }
  void tickWith(const StylusMotion& first) { tick(ToolMotions{first}); }
  layout::TickStats stats() { return lastStats(*solver_); }
  const Body& body() const { return model_.bodies[0]; }
  const Lattice& lattice() const { return body().lattice; }
  double tick_s() const { return static_cast<double>(substeps_) * solver_->dt_s(); }
  void expectSameDisplacement() {
    // Relative to the largest value; contact projections add roundings of absolute positions (6e-8 of ~0.1 m on u of
    // ~1e-3 m).
    constexpr double kContactFloat32 = 1e-4;
    EXPECT_LT(relativeError(solver_->readState().displacement_m, reference_->u_m, reference_->active), kContactFloat32);
  }

  size_t substeps_;
  Model model_;
  std::vector<StylusConfig> styluses_;
  std::unique_ptr<TissueStepper> solver_;
  std::optional<ReferenceSolver> reference_;
};

}  // namespace viscera::test
