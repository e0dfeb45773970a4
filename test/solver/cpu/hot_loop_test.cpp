// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "solver/cpu/cpu_solver.h"
#include "support/counted_memory.h"
#include "support/lattices.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr int kWarmUpTicks = 50, kTicks = 1000;
constexpr double kSpacing_m = 0.004;
constexpr Integrator kAllIntegrators[] = {Integrator::kLeapfrog, Integrator::kVerletPaper, Integrator::kPd};
// Heap and stacks of threads that start and end elsewhere in the process; 1000 ticks of one float each would be 4 kB.
constexpr double kResidentNoise_bytes = 256 * 1024;

double residentBytes() {
  std::ifstream stream("/proc/self/statm");
  double size = 0, resident = 0;
  stream >> size >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// A block fixed at its bottom with every feature of a scene except parts: a law, a dashpot, the stability monitor, two
/// styluses.
class HotLoop : public ::testing::Test {
 protected:
  HotLoop() : model_(test::modelOf({heldBlock(Law::kNeoHookean)})) {
    scene_.styluses.resize(2);
    scene_.solver.tick_hz = 500;
    scene_.solver.threads = 2;
    scene_.solver.iterations = 3;
    scene_.solver.max_substeps = 10000;
  }

  static Body heldBlock(Law law) {
    Body body = test::boxBody({9, 9, 5}, kSpacing_m);
    if (law == Law::kNeoHookean) body = test::ofLaw(body);
    for (uint32_t slot : body.lattice.active_slots) {
      if (body.lattice.nodeAt(slot).z() == 0) body.lattice.nodes[slot].lo |= layout::kFixedBit;
    }
    return body;
  }

  /// Returns a stylus that moves back and forth over the block's top, as deep as its nodes.
  static ToolMotions motionsAt(int tick, ToolMode mode) {
    const auto position = [](int t) { return Vector3d(0.018 + 0.004 * std::sin(0.05 * t), 0.018, 0.02); };
    ToolMotions motions;
    motions[0].mode = mode;
    motions[0].present = true;
    motions[0].from.position_m = position(tick - 1);
    motions[0].to.position_m = position(tick);
    motions[0].hold_begins = mode == ToolMode::kGrab && tick % 100 == 0;
    if (mode == ToolMode::kGrab && tick % 100 == 90) motions[0].hold_ended = mode;
    return motions;
  }

  /// Runs probe, grab and cut in turn, or the probe alone. @return nodes touched, over all ticks
  uint64_t run(CpuSolver& solver, int ticks, bool all_tools) {
    constexpr ToolMode kModes[] = {ToolMode::kProbe, ToolMode::kGrab, ToolMode::kCut, ToolMode::kCutParticles};
    uint64_t touched = 0;
    layout::TickStats stats;
    for (int t = 0; t < ticks; ++t) {
      solver.step(motionsAt(t, all_tools ? kModes[(t / 100) % 4] : ToolMode::kProbe));
      while (solver.pollStats(stats, true)) touched += stats.touched[0];
    }
    return touched;
  }

  Model model_;
  Scene scene_;
};

TEST_F(HotLoop, TheCounterCounts) {
  const uint64_t before = allocations;
  const std::vector<double> memory(100);
  EXPECT_EQ(allocations, before + 1) << memory.size();
}

TEST_F(HotLoop, AllocatesNothingInAThousandTicksOfContact) {
  CpuSolver solver(model_, scene_);
  run(solver, kWarmUpTicks, false);
  const uint64_t before = allocations;
  EXPECT_GT(run(solver, kTicks, false), 0u) << "the probe touched nothing";
  EXPECT_EQ(allocations, before);
}

TEST_F(HotLoop, AllocatesNothingWhateverToolsDo) {
  CpuSolver solver(model_, scene_);
  run(solver, kWarmUpTicks, true);
  const uint64_t before = allocations;
  EXPECT_GT(run(solver, kTicks, true), 0u);
  EXPECT_EQ(allocations, before);
}

TEST_F(HotLoop, AllocatesNothingWithAnyIntegrator) {
  const Model springs = test::modelOf({heldBlock(Law::kSprings)});
  for (Integrator integrator : kAllIntegrators) {
    scene_.solver.integrator = integrator;
    CpuSolver solver(springs, scene_);
    run(solver, 10, false);
    const uint64_t before = allocations;
    run(solver, 20, false);
    EXPECT_EQ(allocations, before) << static_cast<int>(integrator);
  }
}

TEST_F(HotLoop, KeepsResidentMemoryFlat) {
  CpuSolver solver(model_, scene_);
  run(solver, kWarmUpTicks, false);
  const double before = residentBytes();
  run(solver, kTicks, false);
  EXPECT_NEAR(residentBytes(), before, kResidentNoise_bytes);
}

}  // namespace
}  // namespace viscera
