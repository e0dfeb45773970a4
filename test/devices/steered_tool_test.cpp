// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/steered_tool.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/text.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using test::says;

constexpr double kSteeredToolRounding = 1e-12;
constexpr SteeredSpeed kSpeed{0.1, 1.5};

TEST(SteeredTool, ApproachesAJumpAtItsSpeedAndArrives) {
  const Pose from{{0, 0, 0.1}, Quaterniond::Identity()};
  const Pose target{{0.3, 0, 0.1}, Quaterniond(Eigen::AngleAxisd(1.0, Vector3d::UnitX()))};
  const Pose next = approach(from, target, kSpeed, 0.01);
  EXPECT_NEAR((next.position_m - from.position_m).norm(), 0.001, kSteeredToolRounding);
  EXPECT_NEAR(next.orientation.angularDistance(from.orientation), 0.015, kSteeredToolRounding);
  EXPECT_NEAR(next.position_m.x(), 0.001, kSteeredToolRounding);
  Pose at = from;
  for (int i = 0; i < 301; ++i) at = approach(at, target, kSpeed, 0.01);
  EXPECT_EQ(at.position_m, target.position_m);
  EXPECT_EQ(at.orientation.coeffs(), target.orientation.coeffs());
}

TEST(SteeredTool, ApproachTakesTheShortWayRound) {
  const Quaterniond turn(Eigen::AngleAxisd(0.5, Vector3d::UnitZ()));
  const Quaterniond same_turn(-turn.w(), -turn.x(), -turn.y(), -turn.z());
  const Pose at = approach({}, {Vector3d::Zero(), same_turn}, kSpeed, 0.1);
  EXPECT_NEAR(at.orientation.angularDistance(turn), 0.35, kSteeredToolRounding);
}

TEST(SteeredTool, DrivesAlongAndAboutTheAxesOfTheFrame) {
  const Pose from{{0.01, 0.02, 0.03}, Quaterniond(Eigen::AngleAxisd(1.0, Vector3d::UnitX()))};
  const Pose at = drive(from, {{1, 0, -0.5}, {0, 0, 1}}, kSpeed, 0.1);
  EXPECT_LT((at.position_m - Vector3d(0.02, 0.02, 0.025)).norm(), kSteeredToolRounding);
  EXPECT_LT(at.orientation.angularDistance(Quaterniond(Eigen::AngleAxisd(0.15, Vector3d::UnitZ())) * from.orientation),
            1e-7);  // of acos near 1
  EXPECT_EQ(drive(from, {}, kSpeed, 0.1).orientation.coeffs(), from.orientation.coeffs());
}

TEST(SteeredTool, StaysWithinItsReach) {
  EXPECT_LT((within({{1, 0, 0.1}, {}}, {0, 0, 0.1}, 0.2).position_m - Vector3d(0.2, 0, 0.1)).norm(),
            kSteeredToolRounding);
  EXPECT_EQ(within({{0.1, 0, 0.1}, Quaterniond::Identity()}, {0, 0, 0.1}, 0.2).position_m.x(), 0.1);
}

TEST(AxisMap, TakesAxesBySignAndNumber) {
  const AxisMap map("1 -0 none none none 3");
  const Deflection found = map.deflection({0.5F, -1, 0.7F, 0.25F}, 0);
  EXPECT_EQ(found.linear, Vector3d(-1, -0.5, 0));
  EXPECT_EQ(found.angular, Vector3d(0, 0, 0.25));
  EXPECT_TRUE(map.fits({0, 0, 0, 0}));
  EXPECT_FALSE(map.fits({0, 0, 0}));
}

TEST(AxisMap, DeadZoneIsNoneAndGrowsFromItsBorder) {
  const AxisMap map("0 1 2 none none none");
  const float beyond = 3, nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(map.deflection({0.1F, -0.1F, 0}, 0.125).linear, Vector3d::Zero());
  EXPECT_EQ(map.deflection({0.5625F, -1, beyond}, 0.125).linear, Vector3d(0.5, -1, 1));
  EXPECT_EQ(map.deflection({nan, 0, 0}, 0.125).linear, Vector3d::Zero());
  EXPECT_EQ(map.deflection({}, 0.125).linear, Vector3d::Zero());
}

TEST(AxisMap, BadTextsAreRefused) {
  for (const char* text : {"", "0 1 2 3 4", "0 1 2 3 4 5 6", "0 1 2 3 4 x", "0 1 2 3 4 -", "0 1 2 3 4 99999"})
    EXPECT_TRUE(says(test::messageOf<Error>([&] { AxisMap map(text); }), {"six words", "none", text})) << text;
}

}  // namespace
}  // namespace viscera
