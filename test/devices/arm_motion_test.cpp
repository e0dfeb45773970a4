// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/arm_motion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace viscera {
namespace {

constexpr double kRounding = 1e-12;  // m

ArmConfig config() {
  ArmConfig config;
  config.start_m = Vector3d::Zero();
  config.start_rotation_deg = Vector3d::Zero();
  config.speed_m_per_s = 0.1;
  config.turn_deg_per_s = 90;
  return config;
}

Pose at(double x_m, double turn_deg = 0) {
  return {{x_m, 0, 0}, rotationFromDegrees({0, 0, turn_deg})};
}

TEST(ArmMotion, ServoIsFollowedAtOnce) {
  ArmMotion arm(config());
  EXPECT_TRUE(arm.servo(at(0.3)));
  EXPECT_EQ(arm.setpoint().position_m.x(), 0.3);
  EXPECT_FALSE(arm.busy());
}

TEST(ArmMotion, MoveGoesNoFasterThanItMayAndEndsAtItsGoal) {
  ArmMotion arm(config());
  ASSERT_TRUE(arm.move(at(0.1)));
  constexpr double kTick_s = 1e-3, kSecants = 1e-4;  // m/s: error of a mean over a millisecond
  double fastest = 0, time_s = 0, before_m = 0;
  while (arm.busy()) {
    arm.advance(kTick_s);
    time_s += kTick_s;
    fastest = std::max(fastest, (arm.setpoint().position_m.x() - before_m) / kTick_s);
    before_m = arm.setpoint().position_m.x();
  }
  EXPECT_NEAR(fastest, 0.1, kSecants);
  EXPECT_NEAR(time_s, 15.0 / 8 * 0.1 / 0.1, 2 * kTick_s);
  EXPECT_LT((arm.setpoint().position_m - Vector3d(0.1, 0, 0)).norm(), kRounding);
}

TEST(ArmMotion, TurnsTakeTheirTimeToo) {
  ArmMotion arm(config());
  arm.move(at(0, 90));
  arm.advance(1);
  EXPECT_TRUE(arm.busy());
  arm.advance(15.0 / 8 - 1 + 1e-9);
  EXPECT_FALSE(arm.busy());
}

TEST(ArmMotion, GoalThatIsThereAlreadyIsBusyForAMoment) {
  ArmMotion arm(config());
  arm.move(at(0));
  EXPECT_TRUE(arm.busy());
  arm.advance(0.01);
  EXPECT_FALSE(arm.busy());
}

TEST(ArmMotion, ServoEndsAMove) {
  ArmMotion arm(config());
  arm.move(at(0.1));
  arm.advance(0.5);
  arm.servo(at(0.02));
  arm.advance(10);
  EXPECT_EQ(arm.setpoint().position_m.x(), 0.02);
}

TEST(ArmMotion, StaysWhereItIsUnlessEnabled) {
  ArmMotion arm(config());
  arm.move(at(0.1));
  EXPECT_FALSE(arm.command("pause"));
  arm.advance(10);
  EXPECT_EQ(arm.setpoint().position_m.x(), 0);
  EXPECT_FALSE(arm.servo(at(0.2)));
  EXPECT_FALSE(arm.move(at(0.2)));
  EXPECT_FALSE(arm.servoJaw(0));
  EXPECT_FALSE(arm.command("disable"));
  EXPECT_STREQ(text(arm.state()), "DISABLED");
  EXPECT_TRUE(arm.command("resume"));  // returns an error
  EXPECT_FALSE(arm.command("enable"));
  EXPECT_TRUE(arm.servo(at(0.2)));
}

TEST(ArmMotion, HomesAndRefusesWhatItDoesNotKnow) {
  ArmMotion arm(config());
  EXPECT_FALSE(arm.command("unhome"));
  EXPECT_FALSE(arm.homed());
  EXPECT_FALSE(arm.command("home"));
  EXPECT_TRUE(arm.homed());
  EXPECT_EQ(arm.command("dance"), "'dance' is not one of enable, disable, pause, resume, home, unhome");
}

TEST(ArmMotion, VelocityGoesOnForAMomentAndIsHeldByNothingElse) {
  ArmMotion arm(config());
  ASSERT_TRUE(arm.servoVelocity({0.05, 0, 0}, {0, 0, 1}));
  EXPECT_TRUE(arm.moves());
  EXPECT_FALSE(arm.busy());  // a client that waits for the end of a move does not wait for this
  for (int i = 0; i < 10; ++i) {
    arm.advance(0.01);
    arm.servoVelocity({0.05, 0, 0}, {0, 0, 1});
  }
  EXPECT_NEAR(arm.setpoint().position_m.x(), 0.005, kRounding);
  EXPECT_NEAR(arm.setpoint().orientation.angularDistance(Quaterniond::Identity()), 0.1, 1e-9);
  arm.advance(1);  // the command is not repeated
  EXPECT_NEAR(arm.setpoint().position_m.x(), 0.005 + 0.05 * ArmMotion::kVelocityHolds_s, kRounding);
  EXPECT_FALSE(arm.moves());
}

TEST(ArmMotion, HoldStopsWhateverMoves) {
  ArmMotion arm(config());
  arm.move(at(0.1));
  arm.moveJaw(0);
  arm.advance(0.5);
  const double there = arm.setpoint().position_m.x(), jaw = arm.jaw_rad();
  EXPECT_EQ(arm.goal().position_m.x(), 0.1);
  EXPECT_TRUE(arm.hold());
  arm.advance(5);
  EXPECT_EQ(arm.setpoint().position_m.x(), there);
  EXPECT_EQ(arm.goal().position_m.x(), there);
  EXPECT_EQ(arm.jaw_rad(), jaw);
  EXPECT_FALSE(arm.busy());
  arm.command("pause");
  EXPECT_FALSE(arm.hold());
  EXPECT_FALSE(arm.servoVelocity({1, 0, 0}, {0, 0, 0}));
  EXPECT_FALSE(arm.moveJaw(0));
}

TEST(ArmMotion, JawsMoveBesideTheArmAndTakeTheirTime) {
  ArmMotion arm(config());
  const double open_rad = arm.jaw_rad();
  arm.move(at(0.001));
  ASSERT_TRUE(arm.moveJaw(0));
  arm.advance(0.1);
  EXPECT_TRUE(arm.busy());  // the jaws are busy
  EXPECT_EQ(arm.setpoint().position_m.x(), 0.001);
  EXPECT_LT(arm.jaw_rad(), open_rad);
  EXPECT_GT(arm.jaw_rad(), 0);
  arm.advance(15.0 / 8 * open_rad / (M_PI / 2));
  EXPECT_EQ(arm.jaw_rad(), 0);
  EXPECT_FALSE(arm.busy());
  arm.moveJaw(1);
  arm.servoJaw(0.2);
  arm.advance(5);
  EXPECT_EQ(arm.jaw_rad(), 0.2);
}

}  // namespace
}  // namespace viscera
