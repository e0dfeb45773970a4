// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/gl.h"
#include "support/gpu_fixture.h"
#include "support/lattices.h"
#include "support/text.h"
#include "viscera/math/error.h"

using namespace viscera;
using namespace viscera::test;

namespace {

class GpuSolverErrors : public GpuTest {
 protected:
  void step() {
    layout::TickStats stats;
    for (int t = 0; t < 5; ++t) {
      solver_.step({});
      while (solver_.pollStats(stats, true)) {
      }
    }
  }
  const Model model_ = modelOf({boxBody({3, 3, 3}, 0.01)});
  GpuSolver solver_{model_, sceneFor(model_, 4), {}};
};

}  // namespace

TEST_F(GpuSolverErrors, OfOpenGlComeOutOfTheTickInWhichTheyHappen) {
  EXPECT_NO_THROW(step());
  glEnable(0xffff);
  EXPECT_TRUE(says(messageOf<GpuError>([&] { solver_.step({}); }), {"0x0500", "tick"}));
}

/// As when memory that a driver promised is missing: everything read back is zero.
TEST_F(GpuSolverErrors, EmptyMeasurementsAreNotTakenForTissueAtRest) {
  EXPECT_TRUE(says(messageOf<GpuError>([] { requireSignOfLife({}); }), {"does not step the tissue", "out of memory"}));
  EXPECT_NO_THROW(step());
  layout::TickStats at_rest{};
  solver_.step({});
  ASSERT_TRUE(solver_.pollStats(at_rest, true));
  EXPECT_EQ(at_rest.kinetic_j, 0);  // tissue at rest has none of this, and is distinguished nevertheless
  EXPECT_NO_THROW(requireSignOfLife(at_rest));
}
