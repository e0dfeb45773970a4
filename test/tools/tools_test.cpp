// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/tools.h"

#include <gtest/gtest.h>

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

/// Returns tools of one stylus that probes, grabs with button 1 and cuts with button 2.
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
  EXPECT_FALSE(motion.hold_begins);
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
  EXPECT_TRUE(tools.advance(one(0, true))[0].hold_begins);
  const StylusMotion held = tools.advance(one(0, true))[0];
  EXPECT_FALSE(held.hold_begins);
  EXPECT_EQ(held.hold_ended, ToolMode::kNone);
  const StylusMotion released = tools.advance(one(0))[0];
  EXPECT_EQ(released.hold_ended, ToolMode::kGrab);
  EXPECT_FALSE(released.hold_begins);
  EXPECT_EQ(tools.advance(one(0))[0].hold_ended, ToolMode::kNone);
}

TEST(Tools, LostStylusEndsItsGrabWhereItWas) {
  Tools tools = oneStylus();
  tools.advance(one(3, true));
  const StylusMotion lost = tools.advance({})[0];
  EXPECT_EQ(lost.hold_ended, ToolMode::kGrab);
  EXPECT_EQ(lost.mode, ToolMode::kNone);
  EXPECT_EQ(lost.to.position_m.x(), 3);
  EXPECT_EQ(tools.advance({})[0].hold_ended, ToolMode::kNone);
  EXPECT_TRUE(tools.advance(one(3, true))[0].hold_begins);  // still pressed when it comes back: a new grab
}

TEST(Tools, CutEndsAGrab) {
  Tools tools = oneStylus();
  tools.advance(one(0, true));
  const StylusMotion motion = tools.advance(one(0, true, true))[0];
  EXPECT_EQ(motion.mode, ToolMode::kCut);
  EXPECT_EQ(motion.hold_ended, ToolMode::kGrab);
}

TEST(Tools, ANewModeOfThePressedButtonEndsTheHold) {
  Tools tools = oneStylus();
  tools.advance(one(0, true));
  tools.setMode(0, ToolSwitch::kButton2, ToolMode::kNone);
  EXPECT_EQ(tools.advance(one(0, true))[0].hold_ended, ToolMode::kNone) << "the other button's mode";
  tools.setMode(0, ToolSwitch::kButton1, ToolMode::kCut);
  const StylusMotion motion = tools.advance(one(0, true))[0];
  EXPECT_EQ(motion.mode, ToolMode::kCut);
  EXPECT_EQ(motion.hold_ended, ToolMode::kGrab);
  tools.reset();
  EXPECT_EQ(tools.advance(one(0, true))[0].mode, ToolMode::kCut) << "modes stay over a reset";
}

TEST(Tools, AShaftGoesBackBehindABladeAtOnceAndComesForwardSlowly) {
  constexpr double kRounding_m = 1e-12, kStep_m = 0.1 / 60;
  StylusConfig config;
  config.shaft_contact = true;
  config.shaft_radius_m = 0.003;
  config.cut.blade_length_m = 0.02;
  Tools tools({config});
  EXPECT_EQ(tools.advance(one(0))[0].shaft_to_m, 0) << "within the ball";
  const StylusMotion cuts = tools.advance(one(0, false, true))[0];
  EXPECT_NEAR(cuts.shaft_from_m, 0.023, kRounding_m);
  EXPECT_NEAR(cuts.shaft_to_m, 0.023, kRounding_m);
  const StylusMotion after = tools.advance(one(0))[0];
  EXPECT_NEAR(after.shaft_from_m, 0.023, kRounding_m);
  EXPECT_NEAR(after.shaft_to_m, 0.023 - kStep_m, kRounding_m);
  for (int tick = 0; tick < 20; ++tick) tools.advance(one(0));
  EXPECT_EQ(tools.advance(one(0))[0].shaft_to_m, 0);
  tools.advance({});
  EXPECT_EQ(tools.advance(one(0))[0].shaft_from_m, 0);
  EXPECT_LT(oneStylus().advance(one(0))[0].shaft_to_m, 0) << "without shaft_contact";
}

/// A tip at rest, and a shaft that turns by 90 degrees.
TEST(Tools, TheFarEndOfAShaftIsNoFasterThanATip) {
  constexpr double kTravel_m = 0.01;
  StylusConfig config;
  config.shaft_contact = true;
  ToolLimits limits;
  limits.max_travel_m = kTravel_m;
  Tools tools({config}, limits);
  tools.advance(one(0));
  StylusSamples turned = one(0);
  turned[0].pose.orientation = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX());
  const StylusMotion motion = tools.advance(turned)[0];
  const Vector3d end(0, 0, config.shaft_length_m);
  EXPECT_TRUE(motion.speed_limited);
  EXPECT_LT((motion.to * end - motion.from * end).norm(), 1.2 * kTravel_m);
  EXPECT_GT((motion.to * end - motion.from * end).norm(), 0.5 * kTravel_m);
}

TEST(Tools, AModeThatComesToPushFeelsFirst) {
  constexpr double kFeel_m = 0.01;
  StylusConfig config;
  config.idle = ToolMode::kNone;
  Tools tools({config}, ToolLimits{1, kFeel_m});
  tools.advance(one(0));
  tools.foundOutside(0);
  tools.advance(one(0.001));
  tools.setMode(0, ToolSwitch::kIdle, ToolMode::kProbe);
  EXPECT_EQ(tools.advance(one(0.001))[0].feels_m, kFeel_m);
  tools.foundOutside(0);
  tools.setMode(0, ToolSwitch::kIdle, ToolMode::kProbe);
  EXPECT_EQ(tools.advance(one(0.001))[0].feels_m, 0) << "it pushed already";
}

TEST(Tools, ResetForgetsPosesAndGrabs) {
  Tools tools = oneStylus();
  tools.advance(one(1, true));
  tools.reset();
  const StylusMotion motion = tools.advance(one(2, true))[0];
  EXPECT_EQ(motion.from.position_m.x(), 2);
  EXPECT_TRUE(motion.hold_begins);
}

TEST(Tools, TheSameModeByAnotherButtonIsTheSameHold) {
  StylusConfig config;
  config.button1 = config.button2 = ToolMode::kGrab;
  Tools tools({config});
  tools.advance(one(0, true));
  const StylusMotion same = tools.advance(one(0, false, true))[0];
  EXPECT_FALSE(same.hold_begins);
  EXPECT_EQ(same.hold_ended, ToolMode::kNone);
}

TEST(Tools, AHoldThatFollowsOneOfAnotherKindEndsItAndBegins) {
  StylusConfig config;
  config.button2 = ToolMode::kSuction;
  Tools tools({config});
  tools.advance(one(0, true));
  const StylusMotion motion = tools.advance(one(0, true, true))[0];
  EXPECT_EQ(motion.mode, ToolMode::kSuction);
  EXPECT_EQ(motion.hold_ended, ToolMode::kGrab);
  EXPECT_TRUE(motion.hold_begins);
}

TEST(Tools, ScissorsCloseOnceAtOneSpeedAndOpenWhenTheyEnd) {
  constexpr double kOpen_rad = 40 * M_PI / 180, kClosed_rad = 0.03;
  StylusConfig config;
  config.button1 = ToolMode::kScissors;
  config.scissors.closing_s = 0.1;
  ToolLimits limits;
  limits.tick_s = 0.02;
  Tools tools({config}, limits);
  tools.advance(one(0));
  double before_rad = kOpen_rad;
  for (int t = 1; t <= 5; ++t) {
    const StylusMotion motion = tools.advance(one(0, true))[0];
    EXPECT_NEAR(motion.opens_from_rad, before_rad, 1e-12) << t;
    EXPECT_NEAR(motion.opens_to_rad, kOpen_rad + 0.2 * t * (kClosed_rad - kOpen_rad), 1e-12) << t;
    before_rad = motion.opens_to_rad;
  }
  const StylusMotion closed = tools.advance(one(0, true))[0];
  EXPECT_EQ(closed.opens_from_rad, closed.opens_to_rad);
  tools.advance(one(0));
  EXPECT_NEAR(tools.advance(one(0, true))[0].opens_from_rad, kOpen_rad, 1e-12);
}

/// Returns tools of one stylus with a probe of 5 mm and a feel radius of 1 cm.
Tools feelingStylus() {
  StylusConfig config;
  config.probe.radius_m = 0.005;
  ToolLimits limits;
  limits.feel_radius_m = 0.01;
  return Tools({config}, limits);
}

TEST(Tools, StylusThatAppearsFeelsUntilItIsFoundOutside) {
  Tools tools = feelingStylus();
  EXPECT_EQ(tools.advance(one(0))[0].feels_m, 0.01);
  EXPECT_EQ(tools.advance(one(0.1))[0].feels_m, 0.01);
  EXPECT_EQ(tools.advance(one(0.1, true))[0].feels_m, 0);  // a tool that holds does not push
  EXPECT_EQ(tools.advance(one(0.1))[0].feels_m, 0.01);
  tools.foundOutside(0);
  EXPECT_EQ(tools.advance(one(0))[0].feels_m, 0);
  tools.advance({});
  EXPECT_EQ(tools.advance(one(0))[0].feels_m, 0.01);
}

TEST(Tools, ClearedToolAppearsAgainAndItsHoldBeginsAgain) {
  Tools tools = feelingStylus();
  tools.advance(one(0, true));
  EXPECT_FALSE(tools.advance(one(0, true))[0].hold_begins);
  tools.clear();
  const StylusMotion motion = tools.advance(one(0.5, true))[0];
  EXPECT_EQ(motion.from.position_m.x(), 0.5);
  EXPECT_EQ(motion.hold_ended, ToolMode::kGrab);
  EXPECT_TRUE(motion.hold_begins);
  EXPECT_FALSE(tools.advance(one(0.5, true))[0].hold_begins);
}

}  // namespace
}  // namespace viscera
