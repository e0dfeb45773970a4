// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/stylus.h"

#include <gtest/gtest.h>

#include <limits>

namespace viscera {
namespace {

Pose poseAt(double x_m) {
  return {Vector3d(x_m, 0, 0), Quaterniond::Identity()};
}

StylusSamples one(double x_m, bool button1 = false, bool button2 = false) {
  StylusSamples samples;
  samples[0] = {true, poseAt(x_m), button1, button2};
  return samples;
}

/// Tools of one stylus that probes, grabs with button 1 and cuts with button 2.
Tools oneStylus() {
  return Tools({StylusConfig{}});
}

TEST(Tools, ButtonsChooseTheModeAndButton2GoesFirst) {
  Tools tools = oneStylus();
  EXPECT_EQ(tools.advance(one(0))[0].mode, ToolMode::kProbe);
  EXPECT_EQ(tools.advance(one(0, true))[0].mode, ToolMode::kGrab);
  EXPECT_EQ(tools.advance(one(0, false, true))[0].mode, ToolMode::kCut);
  EXPECT_EQ(tools.advance(one(0, true, true))[0].mode, ToolMode::kCut);
}

TEST(Tools, StylusWithoutAPoseIsAbsentAndDoesNothing) {
  Tools tools = oneStylus();
  StylusSamples lost;
  lost[0].button1 = true;
  const StylusMotion motion = tools.advance(lost)[0];
  EXPECT_FALSE(motion.present);
  EXPECT_EQ(motion.mode, ToolMode::kNone);
  EXPECT_FALSE(motion.grab_begins);
}

TEST(Tools, StylusIsPresentEvenWhereItsModeIsNone) {
  StylusConfig config;
  config.idle = ToolMode::kNone;
  Tools tools({config});
  const StylusMotion motion = tools.advance(one(0))[0];
  EXPECT_TRUE(motion.present);
  EXPECT_EQ(motion.mode, ToolMode::kNone);
}

TEST(Tools, SecondStylusThatTheSceneDoesNotHaveIsIgnored) {
  Tools tools = oneStylus();
  StylusSamples samples;
  samples[1] = {true, poseAt(1), true, false};
  EXPECT_EQ(tools.advance(samples)[1].mode, ToolMode::kNone);
  EXPECT_FALSE(tools.advance(samples)[1].present);
}

TEST(Tools, MotionGoesFromTheLastPoseToThisOne) {
  Tools tools = oneStylus();
  tools.advance(one(1));
  const StylusMotion motion = tools.advance(one(2))[0];
  EXPECT_EQ(motion.from.position_m.x(), 1);
  EXPECT_EQ(motion.to.position_m.x(), 2);
}

TEST(Tools, FirstPoseIsNoJump) {
  Tools tools = oneStylus();
  EXPECT_EQ(tools.advance(one(5))[0].from.position_m.x(), 5);
}

TEST(Tools, FirstPoseAfterALossIsNoJump) {
  Tools tools = oneStylus();
  tools.advance(one(1));
  tools.advance({});
  EXPECT_EQ(tools.advance(one(7))[0].from.position_m.x(), 7);
}

TEST(Tools, GrabBeginsOnceAndEndsOnce) {
  Tools tools = oneStylus();
  EXPECT_TRUE(tools.advance(one(0, true))[0].grab_begins);
  const StylusMotion held = tools.advance(one(0, true))[0];
  EXPECT_FALSE(held.grab_begins);
  EXPECT_FALSE(held.grab_ends);
  const StylusMotion released = tools.advance(one(0))[0];
  EXPECT_TRUE(released.grab_ends);
  EXPECT_FALSE(released.grab_begins);
  EXPECT_FALSE(tools.advance(one(0))[0].grab_ends);
}

TEST(Tools, LostStylusEndsItsGrabWhereItWas) {
  Tools tools = oneStylus();
  tools.advance(one(3, true));
  const StylusMotion lost = tools.advance({})[0];
  EXPECT_TRUE(lost.grab_ends);
  EXPECT_EQ(lost.mode, ToolMode::kNone);
  EXPECT_EQ(lost.to.position_m.x(), 3);
  EXPECT_FALSE(tools.advance({})[0].grab_ends);
  EXPECT_TRUE(tools.advance(one(3, true))[0].grab_begins);  // still pressed when it comes back: a new grab
}

TEST(Tools, CutEndsAGrab) {
  Tools tools = oneStylus();
  tools.advance(one(0, true));
  const StylusMotion motion = tools.advance(one(0, true, true))[0];
  EXPECT_EQ(motion.mode, ToolMode::kCut);
  EXPECT_TRUE(motion.grab_ends);
}

TEST(Tools, ResetForgetsPosesAndGrabs) {
  Tools tools = oneStylus();
  tools.advance(one(1, true));
  tools.reset();
  const StylusMotion motion = tools.advance(one(2, true))[0];
  EXPECT_EQ(motion.from.position_m.x(), 2);
  EXPECT_TRUE(motion.grab_begins);
}

TEST(ForceLimiter, PassesAForceWithinItsLimits) {
  ForceLimiter limiter(5, 1000);
  const Reaction out = limiter.limit({Vector3d(1, 2, 2), Vector3d(0, 0, 0.1), false}, 0.01);
  EXPECT_EQ(out.force_n, Vector3d(1, 2, 2));
  EXPECT_EQ(out.torque_nm, Vector3d(0, 0, 0.1));
  EXPECT_FALSE(out.saturated);
}

TEST(ForceLimiter, SaturatesTheForceAndScalesTheTorqueWithIt) {
  ForceLimiter limiter(5, 1e6);
  const Reaction out = limiter.limit({Vector3d(0, 30, 40), Vector3d(2, 0, 0), false}, 0.01);
  EXPECT_TRUE(out.force_n.isApprox(Vector3d(0, 3, 4)));
  EXPECT_TRUE(out.torque_nm.isApprox(Vector3d(0.2, 0, 0)));
  EXPECT_TRUE(out.saturated);
}

TEST(ForceLimiter, ForceRisesAndFallsNoFasterThanItsRate) {
  ForceLimiter limiter(5, 100);
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
  ForceLimiter limiter(5, 100);
  limiter.limit({Vector3d(1, 0, 0), Vector3d::Zero(), false}, 0.01);
  limiter.reset();
  EXPECT_NEAR(limiter.limit({Vector3d(-3, 0, 0), Vector3d::Zero(), false}, 0.01).force_n.x(), -1, 1e-12);
}

TEST(ForceLimiter, ForceThatIsNotFiniteIsNoForceAtAll) {
  ForceLimiter limiter(5, 1000);
  limiter.limit({Vector3d(3, 0, 0), Vector3d::Zero(), false}, 0.01);
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Reaction out = limiter.limit({Vector3d(bad, 0, 0), Vector3d(0, bad, 0), false}, 0.01);
    EXPECT_EQ(out.force_n, Vector3d::Zero());
    EXPECT_EQ(out.torque_nm, Vector3d::Zero());
    EXPECT_TRUE(out.saturated);
  }
  EXPECT_EQ(limiter.limit({Vector3d(2, 0, 0), Vector3d::Zero(), false}, 0.01).force_n.x(), 2);
}

}  // namespace
}  // namespace viscera
