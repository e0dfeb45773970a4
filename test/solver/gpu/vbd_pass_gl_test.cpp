// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// What only the GPU has; the rest is in solver/vbd_gl_test.cpp.
#include "solver/gpu/vbd_pass.h"

#include "support/implicit.h"

using namespace viscera;
using namespace viscera::test;

using VbdOnGpu = GpuTest;

TEST_F(VbdOnGpu, StateHashDoesNotDependOnGroupSize) {
  expectSameHashForEveryGroupSize(Integrator::kVbd);
}
