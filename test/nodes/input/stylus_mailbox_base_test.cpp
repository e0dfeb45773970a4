// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// The frame of a device's poses, and the offset of a clutch: neither makes the tool jump through the tissue.
#include <gtest/gtest.h>

#include "nodes/input/mailbox_poses.h"
#include "nodes/input/stylus_mailbox.h"

namespace viscera::nodes {
namespace {

constexpr double kPeriod_s = 0.01;  // period of the device [s]

Quaterniond aboutZ(double angle_deg) {
  return Quaterniond(Eigen::AngleAxisd(angle_deg * M_PI / 180, Vector3d::UnitZ()));
}

/// A device on a table with a frame in tf.
class StylusBaseTest : public ::testing::Test {
 protected:
  /// Sends the next pose of the device, without a tick.
  std::optional<Drop> say(const Vector3d& position_m) {
    now_s_ += kPeriod_s;
    DevicePose pose{{position_m, Quaterniond::Identity()}, "table", ros::Time(kBegin_s + now_s_)};
    return mailbox_.put(
        pose, [this](const std::string&) { return FramePose{base_}; }, arrival(now_s_));
  }
  bool taken() { return mailbox_.take(at(now_s_)).valid; }
  bool peeked() const { return mailbox_.peek(at(now_s_)).valid; }
  uint64_t moves() const { return mailbox_.baseMoves(); }

  const Vector3d tip_m_{0.3, 0, 0};  // relative to the base
  Pose base_;
  double now_s_ = 0;
  StylusMailbox mailbox_{config(), "tissue"};
};

TEST_F(StylusBaseTest, ThatLeapsMakesTheStylusAppearAgain) {
  say(tip_m_);
  base_.position_m.x() = 0.004;  // like a base that is carried
  say(tip_m_);
  EXPECT_TRUE(taken());
  EXPECT_EQ(moves(), 0u);
  mailbox_.press(ButtonRole::kButton2, {0}, 0, at(0.3));
  mailbox_.press(ButtonRole::kButton2, {1}, 0, at(now_s_));
  base_.position_m.x() = 0.05;
  say(tip_m_);
  EXPECT_FALSE(taken());
  const StylusSample after = mailbox_.take(at(now_s_));
  EXPECT_TRUE(after.valid);
  EXPECT_FALSE(after.button2);
  EXPECT_EQ(moves(), 1u);
}

TEST_F(StylusBaseTest, ThatRotatesInPlaceMakesTheStylusAppearAgain) {
  say(tip_m_);
  const Vector3d before_m = mailbox_.take(at(now_s_)).pose.position_m;
  base_.orientation = aboutZ(30);
  say(tip_m_);
  const StylusSample leapt = mailbox_.take(at(now_s_));
  EXPECT_GT((leapt.pose.position_m - before_m).norm(), 0.15);
  EXPECT_FALSE(leapt.valid);
  EXPECT_TRUE(taken());
  EXPECT_EQ(moves(), 1u);
}

TEST_F(StylusBaseTest, ThatTurnsAboutTheTipSweepsNoBlade) {
  say(Vector3d::Zero());
  EXPECT_TRUE(taken());
  base_.orientation = aboutZ(30);  // the blade's own axis too: it would twist what it holds
  say(Vector3d::Zero());
  EXPECT_FALSE(taken());
  EXPECT_EQ(moves(), 1u);
}

TEST_F(StylusBaseTest, ThatMovesSoThatTheStylusStaysIsNoLeap) {
  say(tip_m_);
  EXPECT_TRUE(taken());
  base_.orientation = aboutZ(4);  // about the device: its origin moves by 2 cm, without a tool there
  base_.position_m = tip_m_ - base_.orientation * tip_m_;
  EXPECT_GT(base_.position_m.norm(), 0.02);
  say(tip_m_);
  EXPECT_TRUE(taken());
  EXPECT_EQ(moves(), 0u);
}

TEST_F(StylusBaseTest, ThatIsCarriedAndTurnedSlowlyIsFollowed) {
  for (int step = 0; step < 300; ++step) {  // 90 degrees in 3 s, 16 cm a second at the tip
    base_.orientation = aboutZ(0.3 * step);
    base_.position_m.x() = 1e-4 * step;
    say(tip_m_);
    EXPECT_TRUE(peeked()) << step;
    EXPECT_TRUE(taken()) << step;
  }
  EXPECT_EQ(moves(), 0u);
}

/// After a jump, forces between ticks would use the tissue model of the previous position.
TEST_F(StylusBaseTest, ThatLeapsIsSeenWithoutANewPose) {
  say(tip_m_);
  EXPECT_TRUE(taken());
  EXPECT_TRUE(peeked());
  base_.orientation = aboutZ(30);
  say(tip_m_);
  EXPECT_FALSE(peeked());
  EXPECT_FALSE(peeked()) << "looking takes nothing";
  EXPECT_FALSE(taken());
  EXPECT_FALSE(peeked()) << "during the tick without a hand";
  say(tip_m_);
  EXPECT_FALSE(peeked());
  EXPECT_TRUE(taken());
  EXPECT_TRUE(peeked());
}

/// A device with a clutch.
class StylusClutchTest : public ::testing::Test {
 protected:
  std::optional<Drop> say(double x_m, double sent_before_s = 0) {
    now_s_ += kPeriod_s;
    DevicePose pose = poseAt(x_m);
    pose.stamp = ros::Time(kBegin_s + now_s_ - sent_before_s);
    return mailbox_.put(pose, nowhere, arrival(now_s_));
  }
  void clutch(bool pressed) { mailbox_.press(ButtonRole::kClutch, {pressed ? 1 : 0}, 0, at(now_s_)); }
  double x_m() { return mailbox_.take(at(now_s_)).pose.position_m.x(); }

  double now_s_ = 0;
  StylusMailbox mailbox_{config(), "tissue"};
};

TEST_F(StylusClutchTest, HoldsTheLastGoodPositionAndNoneThatWasRefused) {
  say(0.1);
  EXPECT_EQ(say(100), Drop::kOutsideWorkspace);
  clutch(true);
  EXPECT_EQ(say(0.2), std::nullopt);
  EXPECT_NEAR(x_m(), 0.1, kRounding_m);
  clutch(false);
  EXPECT_EQ(say(0.25), std::nullopt);
  EXPECT_NEAR(x_m(), 0.15, kRounding_m);
}

TEST_F(StylusClutchTest, HoldsNothingWhereTheFirstPoseWasRefused) {
  clutch(true);
  EXPECT_EQ(say(100), Drop::kOutsideWorkspace);
  EXPECT_EQ(say(0.1), std::nullopt);
  EXPECT_NEAR(x_m(), 0.1, kRounding_m);
}

TEST_F(StylusClutchTest, GoesOnFromWhereTheLastGoodPoseWas) {
  say(0.1);
  clutch(true);
  say(0.2);
  now_s_ += 0.3;
  EXPECT_EQ(say(0.9, 0.25), Drop::kDelayed);
  clutch(false);
  EXPECT_EQ(say(0.25), std::nullopt);
  EXPECT_NEAR(x_m(), 0.15, kRounding_m);
}

}  // namespace
}  // namespace viscera::nodes
