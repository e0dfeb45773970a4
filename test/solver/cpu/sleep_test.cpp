// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Sleep of bricks specific to the CPU; the rest is in test/solver/sleep_gl_test.cpp.
#include "support/sleeping.h"

using namespace viscera;
using namespace viscera::test;

namespace {

class Sleeping : public ::testing::Test {
 protected:
  const Model model_ = modelOf({sleepyCube()});
};

}  // namespace

TEST_F(Sleeping, GovernorsRollbackWakesAll) {
  for (const bool measured_limit : {false, true}) {
    const auto solver = makeCpu("", model_, sleepyScene(model_, {kSleepSpeed_m_per_s, 0, true, measured_limit}));
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
    scene.solver.tick_hz = 1 / kSleepTick_s;
    scene.solver.sleep_speed_m_per_s = kSleepSpeed_m_per_s;
    const auto solver = makeCpu("", model_, scene, threads);
    settle(*solver);
    for (int t = 0; t < 15; ++t) solver->step(probeAtCorner());
    EXPECT_GT(solver->awakeBricks(), 0u);
    const uint64_t hash = stateHash(model_, solver->readState());
    if (first == 0) first = hash;
    EXPECT_EQ(hash, first) << threads << " threads";
  }
}
