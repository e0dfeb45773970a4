// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Sutures in the ticks of both backends.
#include "solver/processes/suture/suture_bodies.h"
#include "support/random_state.h"
#include "support/solver_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kSpacing_m = 0.01;
constexpr double kSutureTicksForce = 1e-3;  // of a force at rest: the suture creeps in the stylus

/// Returns a scene with 60 mm of suture above a block, its start fixed.
Scene withSuture(const Model& model, double fraction) {
  Scene scene = sceneWith(Integrator::kLeapfrog, model, 10, fraction);
  scene.styluses.emplace_back();
  scene.sutures.emplace_back();
  scene.sutures[0].position_m = Vector3d(-0.03, 0, 0.1);
  scene.sutures[0].path = {{Vector3d(0.03, 0, 0.1)}};
  scene.sutures[0].start = SutureEnd::kFixed;
  return scene;
}

ToolMotions pull(int tick, const Vector3d& offset_m) {
  const Vector3d end_m(0.03, 0, 0.1);
  ToolMotions out = tool(ToolMode::kGrab, end_m + tick * offset_m, end_m + (tick + 1) * offset_m);
  out[0].hold_begins = tick == 0;
  return out;
}

class SutureTicks : public OnBackend {
 protected:
  const Model model_ = modelOf({boxBody({4, 4, 4}, kSpacing_m)});
};

INSTANTIATE_TEST_SUITE_P(Backends, SutureTicks, ::testing::ValuesIn(backendKinds()), backendSuffix);

}  // namespace

TEST_P(SutureTicks, AToolThatPullsFeelsTheSuture) {
  for (const bool stability_monitor : {true, false}) {
    Scene scene = withSuture(model_, 0.5);
    scene.solver.stability_monitor = stability_monitor;
    const auto solver = make(model_, scene);
    layout::TickStats stats{};
    for (int t = 0; t < 60; ++t) {  // 12 mm farther than the suture is long: it slips
      solver->step(pull(t, Vector3d(2e-4, 0, 0)));
      stats = lastStats(*solver);
    }
    const double tick_s = 1 / scene.solver.tick_hz, force_n = static_cast<double>(stats.impulse[0].x) / tick_s;
    const double tension_n = findProcess<SutureBodies>(*solver)->chain(0).tension_n(10);
    EXPECT_GT(tension_n, 0.5 * scene.styluses[0].max_force_n);
    EXPECT_NEAR(force_n, tension_n, kSutureTicksForce * tension_n) << stability_monitor;
    EXPECT_EQ(stats.grabbed[0], 2U);
  }
}

TEST_P(SutureTicks, SuturesGoBackWithBadTicks) {
  Scene scene = withSuture(model_, 100);
  scene.solver.stability_monitor = true;
  SolverOptions unstable;
  unstable.allow_unstable = true;
  const auto solver = make(model_, scene, unstable);
  solver->writeState(randomState(model_, 0.3 * kSpacing_m, 0.1, 5));
  std::vector<uint64_t> hashes = {hashWith(0, *findProcess<SutureBodies>(*solver))};
  uint64_t trips = 0, back = 0;
  for (int t = 0; t < 30; ++t) {
    solver->step(pull(t, Vector3d(-2e-4, 0, 2e-4)));
    const uint64_t now = hashWith(0, *findProcess<SutureBodies>(*solver));
    const bool known = std::find(hashes.begin(), hashes.end(), now) != hashes.end();
    EXPECT_EQ(known, solver->health().trips > trips) << t;
    back += known;
    trips = solver->health().trips;
    hashes.push_back(now);
  }
  EXPECT_GT(back, 0U);
}
