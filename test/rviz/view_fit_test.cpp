// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/view_fit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace viscera::rviz_plugin {
namespace {

TEST(ViewFit, SphereTouchesTheEdgesOfThePicture) {
  constexpr float kFov = 0.8F, kRadius = 0.05F;
  EXPECT_NEAR(fittingDistance(kRadius, kFov, 1), kRadius / std::sin(kFov / 2), 1e-6);
  EXPECT_NEAR(fittingDistance(kRadius, kFov, 2), kRadius / std::sin(kFov / 2), 1e-6);  // it is the height that limits
  const float narrow = std::atan(std::tan(kFov / 2) / 2);
  EXPECT_NEAR(fittingDistance(kRadius, kFov, 0.5F), kRadius / std::sin(narrow), 1e-6);
}

}  // namespace
}  // namespace viscera::rviz_plugin
