// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Bricks at rest sleep, and wake when something happens to them.
#include "solver/cpu/sleep.h"

#include "support/backends.h"
#include "support/random_state.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kSpacing_m = 0.005;
constexpr double kTick_s = 0.005;
constexpr double kDrag_per_s = 60;  // less than twice the slowest mode's frequency: it swings, and soon settles
constexpr double kSleepSpeed_m_per_s = SolverConfig{}.sleep_speed_m_per_s;

/// 13 nodes to a side: 4 bricks to a side. Held at the bottom, and soon at rest.
Body cube() {
  Body body = boxBody({12, 12, 12}, kSpacing_m);
  body.material.drag_per_s = kDrag_per_s;
  for (uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).z() == 0) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  return body;
}

class Sleeping : public ::testing::Test {
 protected:
  std::unique_ptr<CpuSolver> make(double sleep_speed_m_per_s = kSleepSpeed_m_per_s, double gravity_m_per_s2 = 0,
                                  bool governor = false, bool measured_limit = true) const {
    StylusConfig stylus;
    stylus.grab.radius_m = 0.008;
    stylus.cut.blade_length_m = 0.1;
    Scene scene = sceneFor(model_, 1, {stylus}, {0, 0, -gravity_m_per_s2});
    scene.solver.tick_hz = 1 / kTick_s;
    scene.solver.dt_fraction = scene.solver.dt_fraction_strained = 0.75;
    scene.solver.sleep_speed_m_per_s = sleep_speed_m_per_s;
    scene.solver.governor = governor;
    scene.solver.measured_limit = measured_limit;
    return makeCpu("", model_, scene);
  }
  /// @return ticks until nothing is awake, or `most`
  static int settle(CpuSolver& solver, int most = 2000) {
    int ticks = 0;
    for (; ticks < most && (ticks == 0 || solver.awakeBricks() > 0); ++ticks) solver.step({});
    return ticks;
  }
  uint64_t hashOf(const CpuSolver& solver) const { return stateHash(model_, solver.readState()); }
  /// Largest distance of a node between two states [m].
  double difference(const HostState& a, const HostState& b) const {
    double largest = 0;
    for (uint32_t slot : model_.bodies[0].lattice.active_slots) {
      largest = std::max(largest, (xyz(a.displacement_m[slot]) - xyz(b.displacement_m[slot])).norm());
    }
    return largest;
  }

  const Model model_ = modelOf({cube()});
};

/// One stylus that does something at a place, near the corner (0, 0, top) if nothing else is said.
ToolMotions tool(ToolMode mode, const Vector3d& from, const Vector3d& to) {
  ToolMotions motions;
  motions[0].mode = mode;
  motions[0].present = true;
  motions[0].from.position_m = from;
  motions[0].to.position_m = to;
  return motions;
}
const Vector3d kCorner_m(0, 0, 0.06);
/// Stands still, 2 mm deep in the corner. The tip's radius is 6 mm.
ToolMotions probeAtCorner() {
  const Vector3d tip = kCorner_m + Vector3d(0, 0, 0.004);
  return tool(ToolMode::kProbe, tip, tip);
}

}  // namespace

TEST_F(Sleeping, BodyAtRestFallsAsleepAfterAWhileAndStaysAsItIs) {
  const auto solver = make();
  EXPECT_EQ(solver->awakeBricks(), solver->bricks());
  const int quiet_ticks = static_cast<int>(Sleep::kQuiet_s / kTick_s);
  for (int t = 0; t < quiet_ticks - 1; ++t) solver->step({});
  EXPECT_EQ(solver->awakeBricks(), solver->bricks());
  for (int t = 0; t < 2; ++t) solver->step({});
  EXPECT_EQ(solver->awakeBricks(), 0u);
  const uint64_t hash = hashOf(*solver);
  for (int t = 0; t < 9; ++t) solver->step({});
  EXPECT_EQ(hashOf(*solver), hash);
}

TEST_F(Sleeping, NothingSleepsWhereTheSpeedIsZero) {
  const auto solver = make(0);
  for (int t = 0; t < 50; ++t) solver->step({});
  EXPECT_EQ(solver->awakeBricks(), solver->bricks());
}

TEST_F(Sleeping, ProbeWakesWhatItReachesAndWavesWakeTheRest) {
  const auto solver = make();
  ASSERT_LT(settle(*solver), 50);
  solver->step(probeAtCorner());
  const size_t at_once = solver->awakeBricks();
  EXPECT_GT(at_once, 0u);
  EXPECT_LT(at_once, solver->bricks());
  EXPECT_GT(difference(solver->readState(), restState(model_)), 5e-4);  // the corner gives way by some of the 2 mm
  size_t most = at_once;
  for (int t = 0; t < 10; ++t) {
    solver->step(probeAtCorner());
    most = std::max(most, solver->awakeBricks());
  }
  EXPECT_GT(most, at_once);
}

TEST_F(Sleeping, ProbedCornerMovesAsWithoutSleep) {
  for (const double speed_m_per_s : {kSleepSpeed_m_per_s, 100 * kSleepSpeed_m_per_s}) {
    SCOPED_TRACE(speed_m_per_s);
    // What bricks that sleep leave out is slower than that, and the drag of 60 1/s stops it within 1/60 s.
    const double left_out_m = speed_m_per_s / kDrag_per_s;
    const auto sleeper = make(speed_m_per_s), watcher = make(0);
    ASSERT_LT(settle(*sleeper), 50);
    size_t slept = 0;
    double farthest_m = 0;
    for (int t = 0; t < 60; ++t) {
      sleeper->step(probeAtCorner());
      watcher->step(probeAtCorner());
      slept += sleeper->bricks() - sleeper->awakeBricks();
      farthest_m = std::max(farthest_m, difference(sleeper->readState(), watcher->readState()));
    }
    EXPECT_GT(slept, 0u);
    EXPECT_LT(farthest_m, left_out_m);
  }
}

TEST_F(Sleeping, SleepsAgainAfterItWasTouched) {
  const auto solver = make();
  settle(*solver);
  for (int t = 0; t < 20; ++t) solver->step(probeAtCorner());
  EXPECT_LT(settle(*solver), 500);
  layout::TickStats stats{};
  while (solver->pollStats(stats, true)) {
  }
  EXPECT_EQ(stats.kinetic_j, 0);  // measured after it fell asleep, at rest
  EXPECT_EQ(stats.max_speed_bits, 0u);
}

TEST_F(Sleeping, HangingBodyThatSettledLiesWhereItWouldWithoutSleep) {
  // The slowest mode comes to rest as exp(-30 t): once it has been slower than the sleep speed for as long as it takes
  // to fall asleep, it would have moved by this much more (20 nm; measured: 3 nm).
  const double settled_m = kSleepSpeed_m_per_s * std::exp(-0.5 * kDrag_per_s * Sleep::kQuiet_s) / (0.5 * kDrag_per_s);
  const auto sleeper = make(kSleepSpeed_m_per_s, 9.81), watcher = make(0, 9.81);
  const int ticks = settle(*sleeper);
  ASSERT_LT(ticks, 1000);
  for (int t = 0; t < ticks + 200; ++t) watcher->step({});
  const HostState asleep = sleeper->readState();
  EXPECT_GT(difference(asleep, restState(model_)), 0.1 * kSpacing_m);
  EXPECT_LT(difference(asleep, watcher->readState()), settled_m);
  for (int t = 0; t < 10; ++t) sleeper->step({});
  EXPECT_EQ(hashOf(*sleeper), stateHash(model_, asleep));
}

TEST_F(Sleeping, GripWakesWhatItHoldsAndTheTissueFollows) {
  const auto solver = make();
  settle(*solver);
  ToolMotions motions = tool(ToolMode::kGrab, kCorner_m, kCorner_m + Vector3d(-0.002, 0, 0));
  motions[0].hold_begins = true;
  solver->step(motions);
  EXPECT_GT(solver->awakeBricks(), 0u);
  EXPECT_LT(solver->awakeBricks(), solver->bricks());
  const uint32_t corner = static_cast<uint32_t>(model_.bodies[0].lattice.slotAt({0, 0, 12}));
  EXPECT_NEAR(solver->readState().displacement_m[corner].x, -0.002, 1e-8);  // m: float32 at 0.06 m
  // Held for long, it stays awake; let go, it goes back and sleeps.
  motions = tool(ToolMode::kGrab, motions[0].to.position_m, motions[0].to.position_m);
  for (int t = 0; t < 200; ++t) solver->step(motions);
  EXPECT_GT(solver->awakeBricks(), 0u);
  motions[0].mode = ToolMode::kNone;
  motions[0].hold_ended = ToolMode::kGrab;
  solver->step(motions);
  EXPECT_LT(settle(*solver), 500);
  EXPECT_LT(difference(solver->readState(), restState(model_)), 1e-5);
}

TEST_F(Sleeping, CutWakesAndWhatItCarriedFalls) {
  const auto solver = make(kSleepSpeed_m_per_s, 9.81);
  ASSERT_LT(settle(*solver), 1000);
  const HostState before = solver->readState();
  // Along x through the whole width, blade from above, 1 cm of it in the cube: a flap to either side.
  ToolMotions motions = tool(ToolMode::kCut, {-0.02, 0.0275, 0.14}, {0.08, 0.0275, 0.14});
  solver->step(motions);
  layout::TickStats stats{};
  while (solver->pollStats(stats, true)) {
  }
  EXPECT_GT(stats.springs_cut, 0u);
  EXPECT_GT(solver->awakeBricks(), 0u);
  for (int t = 0; t < 20; ++t) solver->step({});
  EXPECT_GT(difference(solver->readState(), before), 1e-5);
}

TEST_F(Sleeping, StateThatIsWrittenWakesAll) {
  const auto solver = make();
  settle(*solver);
  solver->writeState(randomState(model_, 1e-4, 0, 3));
  EXPECT_EQ(solver->awakeBricks(), solver->bricks());
  settle(*solver);
  solver->reset();
  EXPECT_EQ(solver->awakeBricks(), solver->bricks());
}

TEST_F(Sleeping, GovernorsRollbackWakesAll) {
  for (const bool measured_limit : {false, true}) {
    const auto solver = make(kSleepSpeed_m_per_s, 0, true, measured_limit);
    settle(*solver);
    EXPECT_EQ(solver->awakeBricks(), 0u);
    ToolMotions motions = tool(ToolMode::kGrab, kCorner_m, kCorner_m);
    motions[0].hold_begins = true;
    solver->step(motions);
    motions[0].hold_begins = false;
    motions[0].to.position_m = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    solver->step(motions);
    EXPECT_EQ(solver->health().trips, 1u);
    EXPECT_EQ(solver->health().recovering, !measured_limit) << "shorter substeps are tried first";
    EXPECT_EQ(solver->awakeBricks(), solver->bricks());
    const HostState state = solver->readState();
    for (uint32_t slot : model_.bodies[0].lattice.active_slots) {
      ASSERT_TRUE(xyz(state.displacement_m[slot]).allFinite() && xyz(state.velocity_m_per_s[slot]).allFinite());
    }
  }
}

TEST_F(Sleeping, SameBitsForAnyNumberOfThreads) {
  uint64_t first = 0;
  for (int threads : {1, 2, 3}) {
    StylusConfig stylus;
    Scene scene = sceneFor(model_, 10, {stylus});
    scene.solver.tick_hz = 1 / kTick_s;
    scene.solver.sleep_speed_m_per_s = kSleepSpeed_m_per_s;
    const auto solver = makeCpu("", model_, scene, threads);
    settle(*solver);
    for (int t = 0; t < 15; ++t) solver->step(probeAtCorner());
    EXPECT_GT(solver->awakeBricks(), 0u);
    const uint64_t hash = hashOf(*solver);
    if (first == 0) first = hash;
    EXPECT_EQ(hash, first) << threads << " threads";
  }
}

TEST_F(Sleeping, OtherIntegratorsDoNotSleep) {
  Scene scene = sceneWith(Integrator::kPd, model_, 1, 20, 1);
  scene.solver.sleep_speed_m_per_s = 1;
  const auto solver = makeCpu("", model_, scene);
  const int ticks = static_cast<int>(2 * Sleep::kQuiet_s / solver->dt_s());
  for (int t = 0; t < ticks; ++t) solver->step({});
  EXPECT_EQ(solver->awakeBricks(), solver->bricks());
}
