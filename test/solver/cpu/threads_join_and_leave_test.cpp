// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Results are the same to the bit on any number of threads, also where threads join and leave during a run.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "solver/cpu/cpu_solver.h"
#include "solver/cpu/state/thread_pool.h"
#include "support/lattices.h"
#include "viscera/math/state_hash.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr int kTicks = 5, kMost = 7;
constexpr double kThreadsJoinAndLeaveSpacing_m = 0.004;
constexpr Integrator kAllIntegrators[] = {Integrator::kLeapfrog, Integrator::kVerletPaper, Integrator::kPd};

/// Returns a block fixed at its bottom, with a dashpot; of a law, if leapfrog steps it.
Model heldBlock(Integrator integrator) {
  Body body = test::boxBody({13, 13, 9}, kThreadsJoinAndLeaveSpacing_m);
  if (integrator == Integrator::kLeapfrog) body = test::ofLaw(body);
  for (uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).z() == 0) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  return test::modelOf({body});
}

Scene sceneOf(Integrator integrator) {
  Scene scene;
  scene.styluses.resize(1);
  scene.solver.integrator = integrator;
  scene.solver.tick_hz = 200;
  scene.solver.iterations = 3;
  scene.solver.max_substeps = 10000;
  return scene;
}

/// Returns a probe that moves into the block's top and along it.
ToolMotions motionsAt(int tick) {
  const auto position = [](int t) { return Vector3d(0.02 + 0.0005 * t, 0.024, 0.034 - 0.0004 * t); };
  ToolMotions motions;
  motions[0].mode = ToolMode::kProbe;
  motions[0].present = true;
  motions[0].from.position_m = position(tick);
  motions[0].to.position_m = position(tick + 1);
  return motions;
}

uint64_t hashOf(const Model& model, Integrator integrator, const std::shared_ptr<ThreadPool>& threads) {
  CpuSolverOptions options;
  options.threads = threads;
  CpuSolver solver(model, sceneOf(integrator), options);
  for (int t = 0; t < kTicks; ++t) solver.step(motionsAt(t));
  return stateHash(model, solver.readState());
}

/// Changes the number of threads during its lifetime.
class Restless {
 public:
  explicit Restless(ThreadPool& pool)
      : thread_([this, &pool] {
          for (int i = 0; !stop_; ++i) {
            pool.limit(1 + (5 * i) % kMost);
            std::this_thread::sleep_for(std::chrono::microseconds(100 + 37 * (i % 11)));
          }
        }) {}
  ~Restless() {
    stop_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST(Threads, AnyNumberOfThemEndsInTheSameState) {
  for (const Integrator integrator : kAllIntegrators) {
    const Model model = heldBlock(integrator);
    const uint64_t alone = hashOf(model, integrator, makeThreadPool(1));
    for (const int threads : {2, 3, 4, 7})
      EXPECT_EQ(hashOf(model, integrator, makeThreadPool(threads)), alone)
          << static_cast<int>(integrator) << ", " << threads;
  }
}

TEST(Threads, ThatJoinAndLeaveInTheMiddleEndInTheSameState) {
  for (const Integrator integrator : kAllIntegrators) {
    const Model model = heldBlock(integrator);
    const uint64_t alone = hashOf(model, integrator, makeThreadPool(1));
    const auto pool = makeThreadPool(kMost);
    const Restless restless(*pool);
    EXPECT_EQ(hashOf(model, integrator, pool), alone) << static_cast<int>(integrator);
  }
}

}  // namespace
}  // namespace viscera
