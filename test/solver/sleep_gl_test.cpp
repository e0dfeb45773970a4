// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Bricks at rest sleep, and wake when something happens to them, on either backend.
#include <type_traits>

#include "support/random_state.h"
#include "support/sleeping.h"

using namespace viscera;
using namespace viscera::test;

namespace {

struct NoContext {};

template <class Solver>
class SleepingOn : public ::testing::Test {
 protected:
  std::unique_ptr<Solver> makeOf(const Scene& scene) const {
    if constexpr (std::is_same_v<Solver, GpuSolver>)
      return std::make_unique<GpuSolver>(model_, scene);
    else
      return makeCpu("", model_, scene);
  }
  std::unique_ptr<Solver> make(const SleepKind& kind = {}) const { return makeOf(sleepyScene(model_, kind)); }
  uint64_t hashOf(const Solver& solver) const { return stateHash(model_, solver.readState()); }
  double difference(const HostState& a, const HostState& b) const { return farthestApart_m(model_, a, b); }

  std::conditional_t<std::is_same_v<Solver, GpuSolver>, gpu::Context, NoContext> context_;
  const Model model_ = modelOf({sleepyCube()});
};

struct BackendNames {
  template <class Solver>
  static std::string GetName(int) {
    return std::is_same_v<Solver, GpuSolver> ? "gpu" : "cpu";
  }
};
using Backends = ::testing::Types<CpuSolver, GpuSolver>;
TYPED_TEST_SUITE(SleepingOn, Backends, BackendNames);

}  // namespace

TYPED_TEST(SleepingOn, BodyAtRestFallsAsleepAfterAWhileAndStaysAsItIs) {
  const auto solver = this->make();
  EXPECT_EQ(solver->awakeBricks(), solver->bricks());
  const int quiet_ticks = static_cast<int>(Sleep::kQuiet_s / kSleepTick_s);
  for (int t = 0; t < quiet_ticks - 1; ++t) solver->step(ToolMotions{});
  EXPECT_EQ(solver->awakeBricks(), solver->bricks());
  for (int t = 0; t < 2; ++t) solver->step(ToolMotions{});
  EXPECT_EQ(solver->awakeBricks(), 0u);
  const uint64_t hash = this->hashOf(*solver);
  for (int t = 0; t < 9; ++t) solver->step(ToolMotions{});
  EXPECT_EQ(this->hashOf(*solver), hash);
}

TYPED_TEST(SleepingOn, NothingSleepsWhereTheSpeedIsZero) {
  const auto solver = this->make({0});
  for (int t = 0; t < 50; ++t) solver->step(ToolMotions{});
  EXPECT_EQ(solver->awakeBricks(), solver->bricks());
}

TYPED_TEST(SleepingOn, ProbeWakesWhatItReachesAndWavesWakeTheRest) {
  const auto solver = this->make();
  ASSERT_LT(settle(*solver), 50);
  solver->step(probeAtCorner());
  const size_t at_once = solver->awakeBricks();
  EXPECT_GT(at_once, 0u);
  EXPECT_LT(at_once, solver->bricks());
  EXPECT_GT(this->difference(solver->readState(), restState(this->model_)),
            5e-4);  // the corner yields by part of the 2 mm
  size_t most = at_once;
  for (int t = 0; t < 10; ++t) {
    solver->step(probeAtCorner());
    most = std::max(most, solver->awakeBricks());
  }
  EXPECT_GT(most, at_once);
}

TYPED_TEST(SleepingOn, ProbedCornerMovesAsWithoutSleep) {
  for (const double speed_m_per_s : {kSleepSpeed_m_per_s, 100 * kSleepSpeed_m_per_s}) {
    SCOPED_TRACE(speed_m_per_s);
    // Motion that sleeping bricks omit is slower than that, and the drag of 60 1/s stops it within 1/60 s.
    const double left_out_m = speed_m_per_s / kSleepDrag_per_s;
    const auto sleeper = this->make({speed_m_per_s}), watcher = this->make({0});
    ASSERT_LT(settle(*sleeper), 50);
    size_t slept = 0;
    double farthest_m = 0;
    for (int t = 0; t < 60; ++t) {
      sleeper->step(probeAtCorner());
      watcher->step(probeAtCorner());
      slept += sleeper->bricks() - sleeper->awakeBricks();
      farthest_m = std::max(farthest_m, this->difference(sleeper->readState(), watcher->readState()));
    }
    EXPECT_GT(slept, 0u);
    EXPECT_LT(farthest_m, left_out_m);
  }
}

TYPED_TEST(SleepingOn, SleepsAgainAfterItWasTouched) {
  const auto solver = this->make();
  settle(*solver);
  for (int t = 0; t < 20; ++t) solver->step(probeAtCorner());
  EXPECT_LT(settle(*solver), 500);
  const layout::TickStats stats = lastStats(*solver);
  EXPECT_EQ(stats.kinetic_j, 0);  // measured after it fell asleep, at rest
  EXPECT_EQ(stats.max_speed_bits, 0u);
}

TYPED_TEST(SleepingOn, HangingBodyThatSettledLiesWhereItWouldWithoutSleep) {
  // The slowest mode decays as exp(-30 t). Once it has been slower than the sleep speed for the time to fall asleep, it
  // would have moved by this much more (20 nm; measured: 3 nm).
  const double settled_m =
      kSleepSpeed_m_per_s * std::exp(-0.5 * kSleepDrag_per_s * Sleep::kQuiet_s) / (0.5 * kSleepDrag_per_s);
  const auto sleeper = this->make({kSleepSpeed_m_per_s, 9.81}), watcher = this->make({0, 9.81});
  const int ticks = settle(*sleeper);
  ASSERT_LT(ticks, 1000);
  for (int t = 0; t < ticks + 200; ++t) watcher->step(ToolMotions{});
  const HostState asleep = sleeper->readState();
  EXPECT_GT(this->difference(asleep, restState(this->model_)), 0.1 * kSleepSpacing_m);
  EXPECT_LT(this->difference(asleep, watcher->readState()), settled_m);
  for (int t = 0; t < 10; ++t) sleeper->step(ToolMotions{});
  EXPECT_EQ(this->hashOf(*sleeper), stateHash(this->model_, asleep));
}

TYPED_TEST(SleepingOn, GripWakesWhatItHoldsAndTheTissueFollows) {
  const auto solver = this->make();
  settle(*solver);
  ToolMotions motions = tool(ToolMode::kGrab, kCorner_m, kCorner_m + Vector3d(-0.002, 0, 0));
  motions[0].hold_begins = true;
  solver->step(motions);
  EXPECT_GT(solver->awakeBricks(), 0u);
  EXPECT_LT(solver->awakeBricks(), solver->bricks());
  const uint32_t corner = static_cast<uint32_t>(this->model_.bodies[0].lattice.slotAt({0, 0, 12}));
  EXPECT_NEAR(solver->readState().displacement_m[corner].x, -0.002, 1e-8);  // m: float32 at 0.06 m
  // Held for long, it stays awake; once released, it returns and sleeps.
  motions = tool(ToolMode::kGrab, motions[0].to.position_m, motions[0].to.position_m);
  for (int t = 0; t < 200; ++t) solver->step(motions);
  EXPECT_GT(solver->awakeBricks(), 0u);
  motions[0].mode = ToolMode::kNone;
  motions[0].hold_ended = ToolMode::kGrab;
  solver->step(motions);
  EXPECT_LT(settle(*solver), 500);
  EXPECT_LT(this->difference(solver->readState(), restState(this->model_)), 1e-5);
}

TYPED_TEST(SleepingOn, CutWakesAndWhatItCarriedFalls) {
  const auto solver = this->make({kSleepSpeed_m_per_s, 9.81});
  ASSERT_LT(settle(*solver), 1000);
  const HostState before = solver->readState();
  // Along x through the whole width, blade from above, 1 cm of it in the cube: a flap on either side.
  ToolMotions motions = tool(ToolMode::kCut, {-0.02, 0.0275, 0.14}, {0.08, 0.0275, 0.14});
  solver->step(motions);
  const layout::TickStats stats = lastStats(*solver);
  EXPECT_GT(stats.springs_cut, 0u);
  EXPECT_GT(solver->awakeBricks(), 0u);
  for (int t = 0; t < 20; ++t) solver->step(ToolMotions{});
  EXPECT_GT(this->difference(solver->readState(), before), 1e-5);
}

TYPED_TEST(SleepingOn, StateThatIsWrittenWakesAll) {
  const auto solver = this->make();
  settle(*solver);
  solver->writeState(randomState(this->model_, 1e-4, 0, 3));
  EXPECT_EQ(solver->awakeBricks(), solver->bricks());
  settle(*solver);
  solver->reset();
  EXPECT_EQ(solver->awakeBricks(), solver->bricks());
}

TYPED_TEST(SleepingOn, OtherIntegratorsDoNotSleep) {
  Scene scene = sceneWith(Integrator::kPd, this->model_, 1, 20, 1);
  scene.solver.sleep_speed_m_per_s = 1;
  const auto solver = this->makeOf(scene);
  const int ticks = static_cast<int>(2 * Sleep::kQuiet_s / solver->dt_s());
  for (int t = 0; t < ticks; ++t) solver->step(ToolMotions{});
  EXPECT_EQ(solver->awakeBricks(), solver->bricks());
}
