// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// What only the GPU's leapfrog has; the rest is in solver/leapfrog_gl_test.cpp.
#include "solver/gpu/leapfrog_pass.h"

#include "support/random_state.h"

using namespace viscera;
using namespace viscera::test;

using LeapfrogOnGpu = GpuTest;

TEST_F(LeapfrogOnGpu, StateHashDoesNotDependOnGroupSize) {
  const Model model = modelOf({boxBody({9, 7, 8}, 0.01)});
  uint64_t first = 0;
  for (uint32_t group_size : {32u, 64u, 128u, 256u}) {
    GpuSolver solver(model, sceneFor(model, 20, {}, Vector3d(0, 0, -9.81)), {{}, group_size});
    HostState start = randomState(model, 1e-3, 0.5, 11);
    solver.writeState(start);
    for (int t = 0; t < 5; ++t) solver.step({});
    const uint64_t hash = stateHash(model, solver.readState());
    if (first == 0) first = hash;
    EXPECT_EQ(hash, first) << "group size " << group_size;
  }
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
