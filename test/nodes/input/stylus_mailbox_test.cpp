// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/stylus_mailbox.h"

#include <gtest/gtest.h>

#include <limits>

#include "nodes/input/mailbox_poses.h"

namespace viscera::nodes {
namespace {

class StylusMailboxTest : public ::testing::Test {
 protected:
  /// Expects that the message is dropped for this reason, counted, and leaves no sample.
  void expectDropped(const DevicePose& message, Drop reason) {
    EXPECT_EQ(mailbox_.put(message, nowhere, arrival(0)), reason);
    EXPECT_EQ(mailbox_.status(at(0)).dropped[static_cast<size_t>(reason)], 1u);
    EXPECT_FALSE(mailbox_.take(at(0)).valid);
  }
  StylusMailbox mailbox_{config(), "tissue"};
};

TEST_F(StylusMailboxTest, HasNoSampleBeforeTheFirstPose) {
  EXPECT_FALSE(mailbox_.take(at(0)).valid);
}

TEST_F(StylusMailboxTest, PoseInTheTissueFrameNeedsNoTransform) {
  EXPECT_EQ(mailbox_.put(poseAt(0.1), nowhere, arrival(0)), std::nullopt);
  const StylusSample sample = mailbox_.take(at(0.1));
  EXPECT_TRUE(sample.valid);
  EXPECT_EQ(sample.pose.position_m, Vector3d(0.1, 0, 0));
}

TEST_F(StylusMailboxTest, PoseWithoutAFrameIsInTheTissueFrame) {
  EXPECT_EQ(mailbox_.put(poseAt(0.1, ""), nowhere, arrival(0)), std::nullopt);
  EXPECT_EQ(mailbox_.take(at(0)).pose.position_m, Vector3d(0.1, 0, 0));
  EXPECT_EQ(mailbox_.deviceFrame().name, "tissue");
}

TEST_F(StylusMailboxTest, NewerPoseOvertakesTheOlder) {
  mailbox_.put(poseAt(0.1), nowhere, arrival(0));
  mailbox_.put(poseAt(0.2), nowhere, arrival(0.01));
  EXPECT_EQ(mailbox_.take(at(0.02)).pose.position_m.x(), 0.2);
}

TEST_F(StylusMailboxTest, PoseOfADeviceIsBroughtToTheTissueFrame) {
  const auto lookup = [](const std::string& frame) -> FramePose {
    if (frame != "base") return {};
    return {Pose{{0, 0, 0.5}, Quaterniond(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()))}};
  };
  EXPECT_EQ(mailbox_.put(poseAt(0.1, "/base"), lookup, arrival(0)),
            std::nullopt);  // drivers older than tf2 send the slash
  EXPECT_LT((mailbox_.take(at(0)).pose.position_m - Vector3d(0, 0.1, 0.5)).norm(), kRounding_m);
  const DeviceFrame frame = mailbox_.deviceFrame();
  EXPECT_EQ(frame.name, "base");
  EXPECT_LT((frame.from_tissue * Vector3d::UnitY() - Vector3d::UnitX()).norm(), kRounding_m);
}

TEST_F(StylusMailboxTest, UnknownFrameIsDroppedAndNeverTakenForIdentity) {
  expectDropped(poseAt(0.1, "elsewhere"), Drop::kNoTransform);
}

TEST_F(StylusMailboxTest, ZeroStampMeansInvalid) {
  auto message = poseAt(0.1);
  message.stamp = ros::Time();
  expectDropped(message, Drop::kStampZero);
}

TEST_F(StylusMailboxTest, NotANumberIsDropped) {
  expectDropped(poseAt(std::numeric_limits<double>::quiet_NaN()), Drop::kNotFinite);
}

TEST_F(StylusMailboxTest, InfiniteTransformIsDropped) {
  const auto lookup = [](const std::string&) -> FramePose {
    return {Pose{{std::numeric_limits<double>::infinity(), 0, 0}, Quaterniond::Identity()}};
  };
  EXPECT_EQ(mailbox_.put(poseAt(0.1, "base"), lookup, arrival(0)), Drop::kNotFinite);
}

TEST_F(StylusMailboxTest, QuaternionWithoutLengthIsDropped) {
  auto message = poseAt(0.1);
  message.pose.orientation.w() = 0;
  expectDropped(message, Drop::kBadQuaternion);
}

TEST_F(StylusMailboxTest, QuaternionWhoseLengthOverflowsIsDropped) {
  auto message = poseAt(0.1);
  message.pose.orientation.w() = 1e300;
  expectDropped(message, Drop::kBadQuaternion);
}

TEST_F(StylusMailboxTest, QuaternionThatIsNearlyUnitIsNormalised) {
  auto message = poseAt(0.1);
  message.pose.orientation.w() = 1.05;
  EXPECT_EQ(mailbox_.put(message, nowhere, arrival(0)), std::nullopt);
  EXPECT_NEAR(mailbox_.take(at(0)).pose.orientation.norm(), 1, kRounding_m);
}

TEST_F(StylusMailboxTest, PoseOutsideTheWorkspaceIsDropped) {
  expectDropped(poseAt(1000), Drop::kOutsideWorkspace);
  EXPECT_EQ(mailbox_.put(poseAt(0.999), nowhere, arrival(0)), std::nullopt);
}

TEST_F(StylusMailboxTest, DroppedPoseLeavesTheLastGoodOne) {
  mailbox_.put(poseAt(0.1), nowhere, arrival(0));
  mailbox_.put(poseAt(1000), nowhere, arrival(0.1));
  EXPECT_TRUE(mailbox_.take(at(0.15)).valid);
  EXPECT_FALSE(mailbox_.take(at(0.25)).valid);  // and does not keep it alive
}

TEST_F(StylusMailboxTest, PoseGoesStale) {
  mailbox_.put(poseAt(0.1), nowhere, arrival(0));
  EXPECT_TRUE(mailbox_.take(at(0.19)).valid);
  EXPECT_FALSE(mailbox_.take(at(0.21)).valid);
  EXPECT_TRUE(mailbox_.status(at(0.21)).stale);
  mailbox_.put(poseNow(0.3), nowhere, arrival(0.3));
  EXPECT_TRUE(mailbox_.take(at(0.31)).valid);
}

TEST_F(StylusMailboxTest, DriverThatHangsAndRepeatsItsLastMessageGrowsStale) {
  for (double t = 0; t < 1; t += 0.03) {
    const std::optional<Drop> reason = mailbox_.put(poseNow(0), nowhere, arrival(t));
    EXPECT_EQ(mailbox_.take(at(t)).valid, t <= config().stale_after_s) << t;
    EXPECT_EQ(reason, t <= config().stale_after_s ? std::nullopt : std::optional<Drop>(Drop::kRepeatedStamp)) << t;
  }
  EXPECT_EQ(mailbox_.put(poseNow(1), nowhere, arrival(1)), std::nullopt);
  EXPECT_TRUE(mailbox_.take(at(1)).valid);
}

TEST_F(StylusMailboxTest, ClockThatStandsStillIsNoDriverThatHangs) {
  for (double t = 0; t < 1; t += 0.1)
    EXPECT_EQ(mailbox_.put(poseAt(0.1), nowhere, {at(t), ros::Time(kBegin_s)}), std::nullopt) << t;
  EXPECT_TRUE(mailbox_.take(at(1)).valid);
}

TEST_F(StylusMailboxTest, FrameWhoseTransformIsTooOldIsDropped) {
  const auto lookup = [](const std::string&) -> FramePose { return {std::nullopt, true}; };
  EXPECT_EQ(mailbox_.put(poseAt(0.1, "base"), lookup, arrival(0)), Drop::kOldTransform);
}

/// A stylus that has been tracked for a while.
class StylusButtonTest : public StylusMailboxTest {
 protected:
  static constexpr double kNow_s = 1;
  StylusButtonTest() { track(0, kNow_s); }
  void track(double from_s, double to_s) {
    for (double t = from_s; t <= to_s; t += 0.1) mailbox_.put(poseNow(t), nowhere, arrival(t));
    mailbox_.put(poseNow(to_s), nowhere, arrival(to_s));
  }
  void press(size_t button, int value, double time_s = kNow_s) {
    mailbox_.press(button == 0 ? ButtonRole::kButton1 : ButtonRole::kButton2, {value}, 0, at(time_s));
  }
  StylusSample take(double time_s = kNow_s) { return mailbox_.take(at(time_s)); }
};

TEST_F(StylusButtonTest, IsHeldUntilReleased) {
  press(0, 1);
  EXPECT_TRUE(take().button1);
  EXPECT_TRUE(take().button1);
  EXPECT_FALSE(take().button2);
  press(0, 0);
  EXPECT_FALSE(take().button1);
}

TEST_F(StylusButtonTest, ClickIsAPressOfOneTick) {
  press(1, 2);
  EXPECT_TRUE(take().button2);
  EXPECT_FALSE(take().button2);
}

TEST_F(StylusButtonTest, PressBetweenTwoTicksIsNotLost) {
  press(0, 1);
  press(0, 0);
  EXPECT_TRUE(take().button1);
  EXPECT_FALSE(take().button1);
}

TEST_F(StylusButtonTest, EndsWithItsStylusAndMustBeReleasedBeforeItActs) {
  press(1, 1);
  EXPECT_TRUE(take().button2);
  EXPECT_FALSE(take(2).button2);  // tracking was lost
  track(3, 4);
  EXPECT_FALSE(take(4).button2);
  press(1, 1, 4);
  EXPECT_FALSE(take(4).button2);
  EXPECT_EQ(mailbox_.status(at(4)).button_presses_ignored, 1u);
  press(1, 0, 4);
  press(1, 1, 4);
  EXPECT_TRUE(take(4).button2);
}

TEST_F(StylusButtonTest, EndsThoughNotReadWhileTheStylusWasAway) {
  press(1, 1);
  track(3, 3.5);
  EXPECT_FALSE(take(3.5).button2);
}

TEST_F(StylusButtonTest, ButtonWithoutAStylusIsIgnored) {
  press(0, 1, 2);
  track(2.1, 3);
  EXPECT_FALSE(take(3).button1);
  press(0, 2, 5);  // a click too
  track(5.1, 6);
  EXPECT_FALSE(take(6).button1);
}

TEST_F(StylusButtonTest, ThatIsDownWhenTheStylusComesMustBeReleased) {
  track(3, 3.1);
  press(0, 1, 3.1);  // a driver that repeats the state of its buttons
  track(3.2, 4);
  press(0, 1, 4);
  EXPECT_FALSE(take(4).button1);
}

TEST_F(StylusButtonTest, FirstPressOfADriverThatSendsChangesActs) {
  press(0, 1);  // the first message of this button
  EXPECT_TRUE(take().button1);
}

TEST_F(StylusButtonTest, ForgottenOnesMustBeReleased) {
  press(0, 1);
  mailbox_.clearButtons();
  EXPECT_FALSE(take().button1);
  press(0, 1);
  EXPECT_FALSE(take().button1);
  press(0, 0);
  press(0, 1);
  EXPECT_TRUE(take().button1);
}

TEST_F(StylusButtonTest, JoyWithoutOrWithStrangeButtonsIsDropped) {
  EXPECT_EQ(mailbox_.press(ButtonRole::kButton1, {}, 0, at(1)), Drop::kNoButtons);
  EXPECT_EQ(mailbox_.press(ButtonRole::kButton1, {3}, 0, at(1)), Drop::kButtonValue);
  EXPECT_EQ(mailbox_.press(ButtonRole::kButton1, {-1}, 0, at(1)), Drop::kButtonValue);
  EXPECT_FALSE(take().button1);
}

TEST_F(StylusMailboxTest, HeldPoseDoesNotGrowStaleUntilItIsLetGo) {
  mailbox_.hold(true);
  mailbox_.put(poseNow(0), nowhere, arrival(0));
  EXPECT_TRUE(mailbox_.take(at(100)).valid);
  mailbox_.hold(false);
  EXPECT_FALSE(mailbox_.take(at(100.01)).valid);
}

TEST(StylusMailboxOfADevice, ForceFrameIsTheDevicesOwn) {
  DeviceChoice choice;
  choice.stylus = "left";
  choice.overrides = {"pose.axes=x -z y", "pose.unit_m=0.001", "base.position_m=[0,0,0.2]",
                      "tip.position_m=[0,0,-0.1]"};
  StylusMailbox mailbox(config(), "tissue", parseDevice("about: a\n", "device.yaml", choice));
  const Quaterniond none = Quaterniond::Identity();
  EXPECT_EQ(mailbox.put({{{10, 20, 30}, none}, "unknown to tf", ros::Time(kBegin_s)}, nowhere, arrival(0)),
            std::nullopt);
  // the device's -z is the tissue's y: its tip is 0.1 m along it
  EXPECT_LT((mailbox.take(at(0)).pose.position_m - Vector3d(0.01, 0.07, 0.22)).norm(), kRounding_m);
  const DeviceFrame frame = mailbox.deviceFrame();
  EXPECT_LT((frame.from_tissue * Vector3d::UnitZ() - Vector3d::UnitY()).norm(), kRounding_m);
  EXPECT_LT((frame.lever_arm_m - Vector3d(0, 0, -0.1)).norm(), kRounding_m);
  EXPECT_EQ(frame.position, Vector3d(10, 20, 30));
  const Pose in_tissue{{0.01, 0.07, 0.22}, Quaterniond(axesOf("x -z y", ""))};
  EXPECT_LT((mailbox.inDevice(in_tissue).position_m - Vector3d(10, 20, 30)).norm(), 1e3 * kRounding_m);
}

/// A gripper in metres, with 0.5 rad per cm, that presses no button.
TEST_F(StylusMailboxTest, AGripperOpensTheJawsAndWhatIsNoAngleIsDropped) {
  DeviceProfile device;
  EXPECT_EQ(mailbox_.grip({0.01}, 0, at(0)), std::nullopt);
  mailbox_.put(poseAt(0.1), nowhere, arrival(0));
  EXPECT_EQ(mailbox_.take(at(0)).jaw_rad, kNoJaw) << "no profile says that it is heard";
  device.gripper.presses = PressedButton::kJaws;
  device.gripper.rad_per_unit = 50;
  StylusMailbox heard(config(), "tissue", device);
  heard.put(poseAt(0.1), nowhere, arrival(0));
  EXPECT_EQ(heard.take(at(0)).jaw_rad, kNoJaw);
  EXPECT_EQ(heard.grip({0, 0.01}, 1, at(0)), std::nullopt);
  EXPECT_FLOAT_EQ(heard.take(at(0)).jaw_rad, 0.5F);
  EXPECT_FALSE(heard.take(at(0)).button1);
  EXPECT_EQ(heard.grip({std::numeric_limits<double>::quiet_NaN()}, 0, at(0)), Drop::kNotFinite);
  EXPECT_EQ(heard.grip({0.07}, 0, at(0)), Drop::kJawAngle);
  EXPECT_EQ(heard.grip({0.01}, 1, at(0)), Drop::kNoButtons);
  EXPECT_EQ(heard.status(at(0)).dropped[static_cast<size_t>(Drop::kJawAngle)], 1U);
  EXPECT_FLOAT_EQ(heard.take(at(0)).jaw_rad, 0.5F);
  heard.grip({-0.001}, 0, at(0));
  EXPECT_EQ(heard.take(at(0)).jaw_rad, 0);
}

}  // namespace
}  // namespace viscera::nodes
