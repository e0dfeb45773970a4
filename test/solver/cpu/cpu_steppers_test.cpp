// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Integrators of the CPU alone, on threads of the test. Their correctness is tested on every backend
// (test/solver/*_gl_test.cpp).
#include "solver/cpu/state/cpu_stepper.h"

#include <thread>

#include "solver/cpu/kernels/tool_passes.h"
#include "support/features.h"
#include "support/implicit.h"
#include "tools/motion_packing.h"

using namespace viscera;
using namespace viscera::test;

namespace {

/// Runs each job on a thread of its own, the last one first; ranges in the smallest portions.
class Scattered : public Parallel {
 protected:
  void run(size_t count, Portions portions, Call call, const void* job) const override {
    std::vector<std::thread> threads;
    for (size_t end = count; end > 0;) {
      const size_t first = (end - 1) / portions.least * portions.least;
      threads.emplace_back(call, job, first, end);
      end = first;
    }
    for (std::thread& thread : threads) thread.join();
  }
};

uint64_t hashAfterTools(Integrator integrator, const Model& model, const Parallel& parallel) {
  const PullAndProbe tools;
  const FeatureSet features = featuresFor(model, true);
  CpuLattice lattice(model, bodyParams(model, safeTimeStep(model)), features);
  Sleep sleep{lattice, 0};
  const simd::Kernels kernels = simd::kernelsFor("").value();
  Substep step;
  step.dt_s = static_cast<float>((traitsOf(integrator).is_explicit ? 0.5 : 3) * safeTimeStep(model));
  step.kick_s = 0.5f * step.dt_s;
  step.sleep_distance_m = 1e6;
  step.push_speed_m_per_s = static_cast<float>(pushSpeed(model));
  step.tools = step.restarted = true;
  lattice.write(randomState(model, 1e-3, 0.5, 11));
  const auto stepper = makeCpuStepper(integrator, 6, lattice, {parallel, sleep, nullptr, features, kernels});
  for (int t = 0; t < 3; ++t) {
    const ToolMotions motions = tools.motions(t, 0.07);
    if (t == 0) takeHold(lattice, 0, motions[0].from, tools.styluses[0].grab.radius_m);
    std::vector<layout::ToolMotion> rows;
    interpolateMotions(motions, tools.styluses, 1, rows);
    stepper->run(lattice, step, rows.data());
    lattice.swap();
    step.restarted = false;
    step.kick_s = step.dt_s;
  }
  return stateHash(model, lattice.read());
}

}  // namespace

TEST(CpuSteppers, StateHashDoesNotDependOnThreads) {
  const Serial serial;
  const Scattered scattered;
  const Model model = modelOf({boxBody({16, 5, 7}, 0.01)});
  for (const Integrator integrator : {Integrator::kPd, Integrator::kVerletPaper}) {
    EXPECT_EQ(hashAfterTools(integrator, model, scattered), hashAfterTools(integrator, model, serial))
        << static_cast<int>(integrator);
  }
}
