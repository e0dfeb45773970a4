// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// What only the GPU has; the rest is in solver/verlet_paper_gl_test.cpp.
#include "solver/gpu/verlet_paper_pass.h"

#include "support/random_state.h"

using namespace viscera;
using namespace viscera::test;

using VerletPaperOnGpu = GpuTest;

TEST_F(VerletPaperOnGpu, StateHashDoesNotDependOnGroupSize) {
  const Model model = modelOf({boxBody({9, 7, 8}, 0.01)});
  uint64_t first = 0;
  for (uint32_t group_size : {32u, 64u, 128u, 256u}) {
    GpuSolver solver(model, sceneWith(Integrator::kVerletPaper, model, 20, 0.5), {{}, group_size});
    solver.writeState(randomState(model, 1e-3, 0.5, 11));
    for (int t = 0; t < 3; ++t) solver.step({});
    const uint64_t hash = stateHash(model, solver.readState());
    if (first == 0) first = hash;
    EXPECT_EQ(hash, first) << "group size " << group_size;
  }
}
