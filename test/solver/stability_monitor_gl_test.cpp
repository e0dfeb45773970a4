// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>

#include "solver/ticks/stable_step.h"
#include "support/random_state.h"
#include "support/solver_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kMonitoredSpacing_m = 0.01;
constexpr double kEnergyBound = 1.01;  // of the initial energy, at the end of any tick

/// Returns a scene with the stability monitor and a substep of `fraction` times dt_safe.
Scene governed(const Model& model, Integrator integrator, double fraction, int substeps = 10) {
  Scene scene = sceneWith(integrator, model, substeps, fraction);
  scene.solver.stability_monitor = true;
  return scene;
}

SolverOptions unstable() {
  SolverOptions options;
  options.allow_unstable = true;
  return options;
}

class Governed : public OnBackend {
 protected:
  const Model model_ = modelOf({boxBody({4, 4, 4}, kMonitoredSpacing_m)});
};

INSTANTIATE_TEST_SUITE_P(Backends, Governed, ::testing::ValuesIn(backendNames()), backendSuffix);

}  // namespace

TEST_P(Governed, ExplosionIsRolledBackInTheTickInWhichItHappensAndRecoveredFrom) {
  for (Integrator integrator : {Integrator::kLeapfrog, Integrator::kVerletPaper}) {
    for (double fraction : {3.0, 10.0, 100.0}) {
      SCOPED_TRACE(fraction);
      const auto solver = make(model_, governed(model_, integrator, fraction), unstable());
      const HostState start = randomState(model_, 0.3 * kMonitoredSpacing_m, 0.1, 5);
      const double start_j = energyOf(model_, start);
      solver->writeState(start);
      for (int t = 0; t < 30; ++t) {
        solver->step({});
        const HostState state = solver->readState();
        ASSERT_TRUE(isFinite(state)) << "tick " << t;
        ASSERT_LT(energyOf(model_, state), kEnergyBound * start_j) << "tick " << t;
      }
      EXPECT_GT(solver->health().trips, 0u);
      EXPECT_LT(energyOf(model_, solver->readState()), 0.1 * start_j);
    }
  }
}

TEST_P(Governed, WithoutGovernorTheSameExplodes) {
  Scene scene = governed(model_, Integrator::kLeapfrog, 10);
  scene.solver.stability_monitor = false;
  const auto solver = make(model_, scene, unstable());
  const HostState start = randomState(model_, 0.3 * kMonitoredSpacing_m, 0.1, 5);
  solver->writeState(start);
  for (int t = 0; t < 5; ++t) solver->step({});
  EXPECT_FALSE(energyOf(model_, solver->readState()) < 1e6 * energyOf(model_, start));  // nor if it is not finite
}

TEST_P(Governed, OrdinarySessionIsTheSameToTheBitWithAndWithoutIt) {
  uint64_t hash[2];
  for (bool stability_monitor : {true, false}) {
    Scene scene = governed(model_, Integrator::kLeapfrog, 0.5);
    scene.solver.stability_monitor = stability_monitor;
    const auto solver = make(model_, scene);
    solver->writeState(randomState(model_, 0.05 * kMonitoredSpacing_m, 0.1, 6));
    for (int t = 0; t < 20; ++t) solver->step({});
    EXPECT_EQ(solver->health().trips, 0u);
    hash[stability_monitor] = stateHash(model_, solver->readState());
  }
  EXPECT_EQ(hash[0], hash[1]);
}

TEST_P(Governed, RecoveryGivesNoForceAndPublishesNothingOfTheBadTick) {
  StylusConfig probe;
  Scene scene = governed(model_, Integrator::kLeapfrog, 10);
  scene.styluses = {probe};
  const auto solver = make(model_, scene, unstable());
  solver->writeState(randomState(model_, 0.3 * kMonitoredSpacing_m, 0.1, 5));
  for (int t = 0; t < 2; ++t) {
    solver->step(probeAt({0.02, 0.02, 0.038}));
    layout::TickStats stats;
    ASSERT_TRUE(solver->pollStats(stats, true));
    EXPECT_EQ(xyz(stats.impulse[0]), Vector3d::Zero().eval());
    EXPECT_EQ(stats.nonfinite, 0u);
    EXPECT_TRUE(std::isfinite(stats.kinetic_j) && std::isfinite(stats.elastic_j));
  }
  EXPECT_TRUE(solver->health().recovering);  // on the GPU one tick after it happened
}

TEST_P(Governed, TissueThatIsDraggedToNoPlaceAtAllIsRolledBack) {
  for (const Model& model : {model_, modelOf({ofLaw(boxBody({4, 4, 4}, kMonitoredSpacing_m))})}) {
    SCOPED_TRACE(static_cast<int>(model.bodies[0].material.law));  // springs recover by pd, a law by shorter substeps
    Scene scene = governed(model, Integrator::kLeapfrog, 0.5);
    scene.styluses = {StylusConfig{}};
    expectNoPlaceIsRolledBack(*make(model, scene), model);
  }
}

TEST_P(Governed, StrainedTissueGetsTheShorterSubstep) {
  Scene scene = governed(model_, Integrator::kLeapfrog, 0.5);
  scene.solver.substeps = 0;
  scene.solver.dt_fraction = 0.75;
  scene.solver.dt_fraction_strained = 0.25;
  scene.solver.tick_hz = 2;  // enough substeps to distinguish them
  /// Returns the substeps of a tick with all tissue stretched by that share, over those of a calm one.
  const auto more = [&](double longer, bool measured) {
    scene.solver.measured_limit = measured;
    const auto solver = make(model_, scene);
    solver->step({});
    const auto calm = static_cast<double>(solver->substepsDone());
    HostState strained = restState(model_);
    for (uint32_t slot : model_.bodies[0].lattice.active_slots) {
      strained.displacement_m[slot] = vec4(longer * model_.bodies[0].lattice.restPosition(slot));
    }
    solver->writeState(strained);
    solver->step({});
    return static_cast<double>(solver->substepsDone()) / calm - 1;
  };
  constexpr double kWhole = 0.1;  // of a calm tick's substeps, some tens: they are integers
  EXPECT_NEAR(more(1.5, false), 0.75 / 0.25, kWhole * 0.75 / 0.25);
  EXPECT_NEAR(more(1.5, true), strainFactor(1.5), kWhole * strainFactor(1.5));  // long springs only
  EXPECT_GT(more(-0.8, true), 4);                                               // collapsed ones
}

TEST_P(Governed, EnergiesAndStableSubstepAreThoseOfTheReference) {
  constexpr double kSum = 1e-5;     // float32 sums
  constexpr double kLawSum = 2e-5;  // of cells of a law, as in law_gl_test.cpp
  const Body box = boxBody({3, 4, 2}, kMonitoredSpacing_m);
  for (const Body& body : {box, ofLaw(box, 0.4)}) {
    SCOPED_TRACE(static_cast<int>(body.material.law));
    const Model model = modelOf({body});
    Scene scene = governed(model, Integrator::kLeapfrog, 0.5, 1);
    const auto solver = make(model, scene);
    const HostState start = randomState(model, 0.1 * kMonitoredSpacing_m, 0.5, 8);
    solver->writeState(start);
    ReferenceSolver reference(model, Vector3d::Zero(), 1);
    load(reference, start);
    const double elastic = body.material.law == Law::kNeoHookean ? kLawSum : kSum;
    EXPECT_NEAR(solver->health().kinetic_j, reference.kineticEnergy(), kSum * reference.kineticEnergy());
    EXPECT_NEAR(solver->health().elastic_j, reference.elasticEnergy(), elastic * reference.elasticEnergy());
    solver->step({});
    layout::TickStats stats;
    ASSERT_TRUE(solver->pollStats(stats, true));
    float rate;
    std::memcpy(&rate, &stats.max_rate_bits, sizeof rate);
    EXPECT_NEAR(2 / std::sqrt(rate), safeTimeStep(model), 1e-5 * safeTimeStep(model));
  }
}

TEST_P(Governed, CellsTurnedInsideOutAreCounted) {
  const auto solver = make(model_, governed(model_, Integrator::kPd, 1, 1));
  HostState mirrored = restState(model_);
  const Lattice& lattice = model_.bodies[0].lattice;
  for (uint32_t slot : lattice.active_slots) {
    mirrored.displacement_m[slot] = vec4({0.04 - 2 * lattice.restPosition(slot).x(), 0, 0});
  }
  solver->writeState(mirrored);
  solver->step({});
  layout::TickStats stats;
  ASSERT_TRUE(solver->pollStats(stats, true));
  EXPECT_EQ(stats.inverted, 64u);
  EXPECT_TRUE(solver->health().strained);
}

TEST_P(Governed, FragmentThatFallsIsStoppedWhereItSleeps) {
  Scene scene = governed(model_, Integrator::kLeapfrog, 0.5);
  scene.environment.gravity_m_per_s2 = Vector3d(0, 0, -9.81);
  scene.solver.sleep_distance_m = 0.02;
  const auto solver = make(model_, scene);
  for (int t = 0; t < 200; ++t) solver->step({});
  for (uint32_t slot : model_.bodies[0].lattice.active_slots) {
    const double away = xyz(solver->readState().displacement_m[slot]).norm();
    ASSERT_LT(away, 0.0201);
    ASSERT_GT(away, 0.01);
  }
  EXPECT_EQ(solver->health().trips, 0u);
}
