// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "viscera/tools/tools.h"

namespace viscera {
namespace {

constexpr double kTravel_m = 0.01;

StylusSamples at(double x) {
  StylusSamples samples;
  samples[0].valid = true;
  samples[0].pose.position_m = Vector3d(x, 0, 0);
  return samples;
}

TEST(SpeedLimited, TipThatJumpsFollowsAtTheGivenTravelUntilItIsThere) {
  Tools tools({StylusConfig{}}, {kTravel_m});
  EXPECT_FALSE(tools.advance(at(0))[0].speed_limited);
  double reached = 0;
  for (int t = 0; t < 3; ++t) {
    const StylusMotion motion = tools.advance(at(0.035))[0];
    EXPECT_TRUE(motion.speed_limited);
    EXPECT_DOUBLE_EQ(motion.from.position_m.x(), reached);
    EXPECT_NEAR(motion.to.position_m.x() - motion.from.position_m.x(), kTravel_m, 1e-15);
    reached = motion.to.position_m.x();
  }
  const StylusMotion last = tools.advance(at(0.035))[0];
  EXPECT_FALSE(last.speed_limited);
  EXPECT_DOUBLE_EQ(last.to.position_m.x(), 0.035);
}

TEST(SpeedLimited, FirstPoseIsWhereTheTipIsHoweverFarItCameFrom) {
  Tools tools({StylusConfig{}}, {kTravel_m});
  const StylusMotion motion = tools.advance(at(0.5))[0];
  EXPECT_FALSE(motion.speed_limited);
  EXPECT_DOUBLE_EQ(motion.from.position_m.x(), 0.5);
}

TEST(SpeedLimited, TipWithinTheTravelIsLeftAlone) {
  Tools tools({StylusConfig{}}, {kTravel_m});
  tools.advance(at(0));
  const StylusMotion motion = tools.advance(at(0.0099))[0];
  EXPECT_FALSE(motion.speed_limited);
  EXPECT_DOUBLE_EQ(motion.to.position_m.x(), 0.0099);
}

}  // namespace
}  // namespace viscera
