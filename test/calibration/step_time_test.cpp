// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/calibration/step_time.h"

#include <gtest/gtest.h>

namespace viscera {
namespace {

TEST(StepTime, IsTheLineThroughTwoMeasurements) {
  const StepTime time = stepTimeThrough({1000, 7e-6}, {9000, 23e-6});
  EXPECT_NEAR(time.overhead_s, 5e-6, 1e-12);
  EXPECT_NEAR(time.per_node_s, 2e-9, 1e-15);
  EXPECT_NEAR(time.of(5000), 15e-6, 1e-12);
}

TEST(StepTime, IsInProportionToTheLargerWhereALineMakesNoSense) {
  for (const double small_s : {30e-6 /* slower than the larger */, 1e-6 /* below zero without nodes */}) {
    const StepTime time = stepTimeThrough({1000, small_s}, {8000, 20e-6});
    EXPECT_EQ(time.overhead_s, 0);
    EXPECT_NEAR(time.per_node_s, 2.5e-9, 1e-15);
  }
}

}  // namespace
}  // namespace viscera
