// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Features of the GPU's integrators only; the rest is in solver/*_gl_test.cpp.
#include "support/implicit.h"

using namespace viscera;
using namespace viscera::test;

class LeapfrogOnGpu : public GpuTest {};
class PdOnGpu : public GpuTest {};

TEST_F(LeapfrogOnGpu, StateHashDoesNotDependOnGroupSizeNorThatOfVerletPaper) {
  const Model model = modelOf({boxBody({9, 7, 8}, 0.01)});
  const HostState start = randomState(model, 1e-3, 0.5, 11);
  const std::vector<ToolMotions> ticks(5);
  expectSameHashForEveryGroupSize(model, sceneFor(model, 20, {}, Vector3d(0, 0, -9.81)), start, ticks);
  expectSameHashForEveryGroupSize(model, sceneWith(Integrator::kVerletPaper, model, 20, 0.5), start, ticks);
}

TEST_F(PdOnGpu, StateHashDoesNotDependOnGroupSize) {
  expectSameHashForEveryGroupSize(Integrator::kPd);
}

TEST_F(LeapfrogOnGpu, HotLoopMakesNoOpenGlObject) {
  const Model model = modelOf({boxBody({4, 5, 6}, 0.01)});
  GpuSolver solver(model, sceneFor(model, 10, {StylusConfig{}}, Vector3d(0, 0, -9.81)));
  layout::TickStats stats;
  solver.step({});
  const size_t before = gpu::objectsCreated();
  for (int t = 0; t < 20; ++t) {
    solver.step({});
    solver.pollStats(stats, false);
  }
  EXPECT_EQ(gpu::objectsCreated(), before);
}
