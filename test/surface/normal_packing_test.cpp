// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <random>

#include "viscera/surface/visible_mesh.h"

using namespace viscera;

TEST(NormalPacking, ComesBackWithinHalfAStep) {
  constexpr float kHalfStep = 0.5f / 511 + 1e-6f;  // [-] 10 signed bits per axis, and float rounding
  std::mt19937 random(3);
  std::normal_distribution<float> gauss;
  for (int i = 0; i < 1000; ++i) {
    const Vector3f normal = Vector3f(gauss(random), gauss(random), gauss(random)).normalized();
    EXPECT_LT((unpackNormal(packNormal(normal)) - normal).cwiseAbs().maxCoeff(), kHalfStep);
  }
}

TEST(NormalPacking, IsGl2101010WithXInTheLowBits) {
  EXPECT_EQ(packNormal({1, 0, 0}), 511u);
  EXPECT_EQ(packNormal({0, 1, 0}), 511u << 10);
  EXPECT_EQ(packNormal({0, 0, 1}), 511u << 20);
  EXPECT_EQ(packNormal({-1, 0, 0}), 513u);
  EXPECT_EQ(packNormal({0, 0, -1}), 513u << 20);
  EXPECT_EQ(unpackNormal(packNormal({0, -1, 0})), Vector3f(0, -1, 0));
}

TEST(NormalPacking, ValuesBeyondOneAreClampedAndNeverSpillIntoOtherAxes) {
  EXPECT_EQ(packNormal({2, 0, -3}), packNormal({1, 0, -1}));
}
