// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Sleep of bricks specific to the GPU: the same bricks as on the CPU, and almost no cost of a tick in which all sleep.
// The rest is in test/solver/sleep_gl_test.cpp.
#include "gpu/gl.h"
#include "support/networks.h"
#include "support/random_state.h"
#include "support/sleeping.h"

using namespace viscera;
using namespace viscera::test;

namespace {

// Float32 on both backends: motion of the tissue within the sleep speed and the decay time of drag, during which one
// may fall asleep a check before the other.
constexpr double kApart_m = 2e-7;

class SleepingOnGpu : public GpuTest {
 protected:
  std::unique_ptr<GpuSolver> make(const SleepKind& kind = {}) const {
    return std::make_unique<GpuSolver>(model_, sleepyScene(model_, kind));
  }
  /// Steps as settle(), until the host knows.
  static void rest(GpuSolver& solver) {
    settle(solver);
    layout::TickStats stats;
    for (int t = 0; t < 4; ++t) {
      solver.step({});
      while (solver.pollStats(stats, true)) {
      }
    }
    ASSERT_TRUE(solver.resting());
  }
  uint64_t hashOf(const Solver& solver) const { return stateHash(model_, solver.readState()); }

  const Model model_ = modelOf({sleepyCube()});
};

/// Counts the kernels that OpenGL runs during its lifetime.
class CountedDispatches {
 public:
  CountedDispatches() {
    count = 0;
    original_ = __glewDispatchCompute;
    original_indirect_ = __glewDispatchComputeIndirect;
    __glewDispatchCompute = [](GLuint x, GLuint y, GLuint z) {
      ++count;
      original_(x, y, z);
    };
    __glewDispatchComputeIndirect = [](GLintptr offset) {
      ++count;
      original_indirect_(offset);
    };
  }
  ~CountedDispatches() {
    __glewDispatchCompute = original_;
    __glewDispatchComputeIndirect = original_indirect_;
  }
  static inline int count = 0;

 private:
  static inline PFNGLDISPATCHCOMPUTEPROC original_ = nullptr;
  static inline PFNGLDISPATCHCOMPUTEINDIRECTPROC original_indirect_ = nullptr;
};

}  // namespace

TEST_F(SleepingOnGpu, WhereNothingSleepsTheHashIsThatWithoutSleep) {
  for (const Law law : {Law::kSprings, Law::kNeoHookean}) {
    const Model model = modelOf({sleepyCube(law)});
    uint64_t hashes[2];
    for (const bool sleeps : {false, true}) {
      GpuSolver solver(model, sleepyScene(model, {sleeps ? 1e-9 : 0, 9.81}));
      solver.writeState(randomState(model, 1e-4, 0.05, 3));
      for (int t = 0; t < 4; ++t) solver.step(probeAtCorner());
      EXPECT_EQ(solver.awakeBricks(), solver.bricks());
      hashes[sleeps] = stateHash(model, solver.readState());
    }
    EXPECT_EQ(hashes[0], hashes[1]) << "law " << static_cast<int>(law);
  }
}

TEST_F(SleepingOnGpu, SameBricksSleepAsOnTheCpuWhateverToolsDo) {
  struct Part {
    int ticks;
    ToolMotions motions;
  };
  const std::vector<Part> script = {
      {60, {}}, {15, probeAtCorner()}, {60, {}}, {1, grabAtCorner()}, {30, holdAtCorner()}, {1, letGoAtCorner()},
      {80, {}}, {1, cutTop()},         {80, {}}};
  for (const Law law : {Law::kSprings, Law::kNeoHookean}) {
    SCOPED_TRACE(static_cast<int>(law));
    const Model model = modelOf({sleepyCube(law)});
    // Fast motion counts as sleep: there is more difference between awake and asleep.
    const Scene scene = sleepyScene(model, {20 * kSleepSpeed_m_per_s});
    const auto cpu = makeCpu("", model, scene);
    GpuSolver gpu(model, scene);
    std::vector<uint8_t> before = cpu->awake();
    size_t most_asleep_beside_awake = 0;
    int tick = 0, differs = 0;
    for (const Part& part : script) {
      for (int t = 0; t < part.ticks; ++t, ++tick) {
        cpu->step(part.motions);
        gpu.step(part.motions);
        const std::vector<uint8_t> now = cpu->awake();
        differs += gpu.awake() != now;
        const size_t awake = cpu->awakeBricks();
        if (awake > 0) most_asleep_beside_awake = std::max(most_asleep_beside_awake, cpu->bricks() - awake);
      }
      EXPECT_EQ(gpu.awake(), cpu->awake()) << "after tick " << tick;
      EXPECT_LT(farthestApart_m(model, gpu.readState(), cpu->readState()), kApart_m) << "after tick " << tick;
    }
    EXPECT_GT(most_asleep_beside_awake, 0u);
    RecordProperty("ticks_that_differ", differs);
    EXPECT_LE(differs, tick / 50) << "of " << tick;
  }
}

TEST_F(SleepingOnGpu, TickAsleepRunsNoKernelOnceTheHostKnows) {
  for (const bool stability_monitor : {false, true}) {
    const auto solver = make({kSleepSpeed_m_per_s, 0, stability_monitor});
    rest(*solver);
    const uint64_t hash = hashOf(*solver);
    {
      const CountedDispatches counted;
      for (int t = 0; t < 20; ++t) solver->step(t < 10 ? ToolMotions{} : probeAt({0, 0, 0.2}));
      EXPECT_EQ(CountedDispatches::count, 0);
      EXPECT_TRUE(solver->resting());
    }
    EXPECT_EQ(hashOf(*solver), hash);
    solver->step(probeAtCorner());
    EXPECT_FALSE(solver->resting());
    EXPECT_GT(solver->awakeBricks(), 0u);
    EXPECT_NE(hashOf(*solver), hash);
  }
}

TEST_F(SleepingOnGpu, ResultDoesNotDependOnWhenMeasurementsAreReadBack) {
  for (const bool stability_monitor : {false, true}) {
    uint64_t first = 0;
    for (const int poll_every : {1, 3, 1000}) {
      const auto solver = make({20 * kSleepSpeed_m_per_s, 0, stability_monitor});
      layout::TickStats stats;
      int rested = 0;
      for (int t = 0; t < 120; ++t) {
        const bool probes = t >= 40 && t < 45;
        solver->step(probes ? probeAtCorner() : probeAt({0.1, 0, 0.1 + 0.001 * (t % 3)}));
        rested += solver->resting();
        while (t % poll_every == 0 && solver->pollStats(stats, true)) {
        }
      }
      EXPECT_GT(rested, 0);
      const uint64_t hash = hashOf(*solver);
      if (first == 0) first = hash;
      EXPECT_EQ(hash, first) << "asked every " << poll_every << " ticks";
    }
  }
}

TEST_F(SleepingOnGpu, MeasurementsOfTissueAsleepAreThoseOfTissueAtRest) {
  const auto solver = make({kSleepSpeed_m_per_s, 9.81});
  layout::TickStats stats{};
  for (int t = 0; t < 3; ++t) solver->step(probeAtCorner());
  while (solver->pollStats(stats, true)) {
  }
  EXPECT_GT(stats.touched[0], 0u);
  rest(*solver);
  solver->step({});
  ASSERT_TRUE(solver->pollStats(stats, true));
  EXPECT_EQ(stats.max_speed_bits, 0u);
  EXPECT_EQ(stats.kinetic_j, 0);
  EXPECT_GT(stats.elastic_j, 0);
  EXPECT_EQ(stats.touched[0], 0u);
  EXPECT_EQ(stats.impulse[0].x, 0);
}

TEST_F(SleepingOnGpu, StateThatIsWrittenAndResetWakeAll) {
  const auto solver = make();
  rest(*solver);
  const HostState moved = randomState(model_, 1e-4, 0, 3);
  solver->writeState(moved);
  EXPECT_EQ(solver->awakeBricks(), solver->bricks());
  solver->step({});
  EXPECT_GT(farthestApart_m(model_, solver->readState(), moved), 1e-6);
  rest(*solver);
  solver->reset();
  EXPECT_EQ(solver->awakeBricks(), solver->bricks());
}

TEST_F(SleepingOnGpu, GovernorsRollbackWakesAll) {
  const auto solver = make({kSleepSpeed_m_per_s, 0, true});
  rest(*solver);
  solver->step(grabAtCorner());
  ToolMotions motions = holdAtCorner();
  motions[0].to.position_m = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  solver->step(motions);
  solver->step({});  // the host learns of it
  EXPECT_EQ(solver->health().trips, 1u);
  EXPECT_EQ(solver->awakeBricks(), solver->bricks());
  for (int t = 0; t < 4; ++t) solver->step({});
  const HostState state = solver->readState();
  for (uint32_t slot : model_.bodies[0].lattice.active_slots) {
    ASSERT_TRUE(xyz(state.displacement_m[slot]).allFinite() && xyz(state.velocity_m_per_s[slot]).allFinite());
  }
}

TEST_F(SleepingOnGpu, NetworksBesideALatticeGoOn) {
  Body net = clothBody(6, 6, 0.005);
  net.material.mass_damping_per_s = 5;
  const Model model = modelOf({sleepyCube(), net});
  for (const double speed_m_per_s : {0.0, kSleepSpeed_m_per_s}) {
    GpuSolver solver(model, sleepyScene(model, {speed_m_per_s}));
    HostState start = restState(model);
    const uint32_t slot = static_cast<uint32_t>(model.slots() - layout::kBrickSlots);
    start.displacement_m[slot] = {0.001f, 0, 0, 0};
    solver.writeState(start);
    for (int t = 0; t < 40; ++t) solver.step({});
    const HostState before = solver.readState();
    solver.step({});
    EXPECT_NE(before.displacement_m[slot].x, solver.readState().displacement_m[slot].x);
    EXPECT_FALSE(solver.resting());
  }
}
