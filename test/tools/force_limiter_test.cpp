// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/force_limiter.h"

#include <gtest/gtest.h>

#include <limits>

namespace viscera {
namespace {

TEST(ForceLimiter, PassesAForceWithinItsLimits) {
  ForceLimiter limiter(ForceLimits{5, 1000});
  const Reaction out = limiter.limit({Vector3d(1, 2, 2), Vector3d(0, 0, 0.1), false}, 0.01);
  EXPECT_EQ(out.force_n, Vector3d(1, 2, 2));
  EXPECT_EQ(out.torque_nm, Vector3d(0, 0, 0.1));
  EXPECT_FALSE(out.saturated);
}

TEST(ForceLimiter, SaturatesTheForceAndScalesTheTorqueWithIt) {
  ForceLimiter limiter(ForceLimits{5, 1e6});
  const Reaction out = limiter.limit({Vector3d(0, 30, 40), Vector3d(2, 0, 0), false}, 0.01);
  EXPECT_TRUE(out.force_n.isApprox(Vector3d(0, 3, 4)));
  EXPECT_TRUE(out.torque_nm.isApprox(Vector3d(0.2, 0, 0)));
  EXPECT_TRUE(out.saturated);
}

TEST(ForceLimiter, ForceRisesAndFallsNoFasterThanItsRate) {
  ForceLimiter limiter(ForceLimits{5, 100});
  const Reaction push{Vector3d(0, 0, 2.5), Vector3d(0, 0.5, 0), false};
  for (double expected_n : {1.0, 2.0, 2.5}) {
    const Reaction out = limiter.limit(push, 0.01);
    EXPECT_NEAR(out.force_n.z(), expected_n, 1e-12);
    EXPECT_NEAR(out.torque_nm.y(), expected_n / 5, 1e-12);
    EXPECT_EQ(out.saturated, expected_n < 2.5);
  }
  for (double expected_n : {1.5, 0.5, 0.0}) EXPECT_NEAR(limiter.limit({}, 0.01).force_n.z(), expected_n, 1e-12);
}

TEST(ForceLimiter, StartsFromZeroAfterReset) {
  ForceLimiter limiter(ForceLimits{5, 100});
  limiter.limit({Vector3d(1, 0, 0), Vector3d::Zero(), false}, 0.01);
  limiter.reset();
  EXPECT_NEAR(limiter.limit({Vector3d(-3, 0, 0), Vector3d::Zero(), false}, 0.01).force_n.x(), -1, 1e-12);
}

TEST(ForceLimiter, ForceThatIsNotFiniteIsNoForceAtAll) {
  ForceLimiter limiter(ForceLimits{5, 1000});
  limiter.limit({Vector3d(3, 0, 0), Vector3d::Zero(), false}, 0.01);
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Reaction out = limiter.limit({Vector3d(bad, 0, 0), Vector3d(0, bad, 0), false}, 0.01);
    EXPECT_EQ(out.force_n, Vector3d::Zero());
    EXPECT_EQ(out.torque_nm, Vector3d::Zero());
    EXPECT_TRUE(out.saturated);
  }
  EXPECT_EQ(limiter.limit({Vector3d(2, 0, 0), Vector3d::Zero(), false}, 0.01).force_n.x(), 2);
}

TEST(ForceLimiter, PureTwistIsSaturatedAndSlewsToo) {
  ForceLimiter limiter(ForceLimits{5, 100, 0.2, 4});
  for (double expected_nm : {0.04, 0.08, 0.12, 0.16, 0.2, 0.2})
    EXPECT_NEAR(limiter.limit({Vector3d::Zero(), Vector3d(0, 0, 3), false}, 0.01).torque_nm.z(), expected_nm, 1e-12);
}

TEST(ForceLimiter, ForceAndTorqueShrinkByOneFactor) {
  ForceLimiter limiter(ForceLimits{5, 1e6, 0.2, 1e6});
  const Reaction out = limiter.limit({Vector3d(4, 0, 0), Vector3d(0, 0.8, 0), false}, 0.01);
  EXPECT_NEAR(out.force_n.x(), 1, 1e-12);
  EXPECT_NEAR(out.torque_nm.y(), 0.2, 1e-12);
}

}  // namespace
}  // namespace viscera
