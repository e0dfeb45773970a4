// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/stylus_mailbox.h"

#include <gtest/gtest.h>

#include <limits>

namespace viscera::nodes {
namespace {

constexpr double kRounding_m = 1e-12;  // double rounding of a rotation and a sum
const SteadyTime kStart = std::chrono::steady_clock::now();

SteadyTime at(double time_s) {
  return kStart + std::chrono::duration_cast<SteadyTime::duration>(std::chrono::duration<double>(time_s));
}

StylusConfig config() {
  StylusConfig config;
  config.stale_after_s = 0.2;
  config.workspace_m = 1;
  return config;
}

geometry_msgs::PoseStamped poseAt(double x_m, const std::string& frame = "tissue") {
  geometry_msgs::PoseStamped message;
  message.header.frame_id = frame;
  message.header.stamp = ros::Time(100);
  message.pose.position.x = x_m;
  message.pose.orientation.w = 1;
  return message;
}

sensor_msgs::Joy joy(std::vector<int> buttons) {
  sensor_msgs::Joy message;
  message.buttons.assign(buttons.begin(), buttons.end());
  return message;
}

std::optional<Pose> nowhere(const std::string&) {
  return std::nullopt;
}

class StylusMailboxTest : public ::testing::Test {
 protected:
  /// The message is dropped for this reason, counted, and leaves no sample.
  void expectDropped(const geometry_msgs::PoseStamped& message, Drop reason) {
    EXPECT_EQ(mailbox_.put(message, nowhere, at(0)), reason);
    EXPECT_EQ(mailbox_.status(at(0)).dropped[static_cast<size_t>(reason)], 1u);
    EXPECT_FALSE(mailbox_.take(at(0)).valid);
  }
  StylusMailbox mailbox_{config(), "tissue"};
};

TEST_F(StylusMailboxTest, HasNoSampleBeforeTheFirstPose) {
  EXPECT_FALSE(mailbox_.take(at(0)).valid);
}

TEST_F(StylusMailboxTest, PoseInTheTissueFrameNeedsNoTransform) {
  EXPECT_EQ(mailbox_.put(poseAt(0.1), nowhere, at(0)), std::nullopt);
  const StylusSample sample = mailbox_.take(at(0.1));
  EXPECT_TRUE(sample.valid);
  EXPECT_EQ(sample.pose.position_m, Vector3d(0.1, 0, 0));
}

TEST_F(StylusMailboxTest, PoseWithoutAFrameIsInTheTissueFrame) {
  EXPECT_EQ(mailbox_.put(poseAt(0.1, ""), nowhere, at(0)), std::nullopt);
  EXPECT_EQ(mailbox_.take(at(0)).pose.position_m, Vector3d(0.1, 0, 0));
  EXPECT_EQ(mailbox_.deviceFrame().name, "tissue");
}

TEST_F(StylusMailboxTest, NewerPoseOvertakesTheOlder) {
  mailbox_.put(poseAt(0.1), nowhere, at(0));
  mailbox_.put(poseAt(0.2), nowhere, at(0.01));
  EXPECT_EQ(mailbox_.take(at(0.02)).pose.position_m.x(), 0.2);
}

TEST_F(StylusMailboxTest, PoseOfADeviceIsBroughtToTheTissueFrame) {
  const auto lookup = [](const std::string& frame) -> std::optional<Pose> {
    if (frame != "base") return std::nullopt;
    return Pose{{0, 0, 0.5}, Quaterniond(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()))};
  };
  EXPECT_EQ(mailbox_.put(poseAt(0.1, "/base"), lookup, at(0)), std::nullopt);  // drivers older than tf2 send the slash
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
  message.header.stamp = ros::Time();
  expectDropped(message, Drop::kStampZero);
}

TEST_F(StylusMailboxTest, NotANumberIsDropped) {
  expectDropped(poseAt(std::numeric_limits<double>::quiet_NaN()), Drop::kNotFinite);
}

TEST_F(StylusMailboxTest, InfiniteTransformIsDropped) {
  const auto lookup = [](const std::string&) -> std::optional<Pose> {
    return Pose{{std::numeric_limits<double>::infinity(), 0, 0}, Quaterniond::Identity()};
  };
  EXPECT_EQ(mailbox_.put(poseAt(0.1, "base"), lookup, at(0)), Drop::kNotFinite);
}

TEST_F(StylusMailboxTest, QuaternionWithoutLengthIsDropped) {
  auto message = poseAt(0.1);
  message.pose.orientation.w = 0;
  expectDropped(message, Drop::kBadQuaternion);
}

TEST_F(StylusMailboxTest, QuaternionWhoseLengthOverflowsIsDropped) {
  auto message = poseAt(0.1);
  message.pose.orientation.w = 1e300;
  expectDropped(message, Drop::kBadQuaternion);
}

TEST_F(StylusMailboxTest, QuaternionThatIsNearlyUnitIsNormalised) {
  auto message = poseAt(0.1);
  message.pose.orientation.w = 1.05;
  EXPECT_EQ(mailbox_.put(message, nowhere, at(0)), std::nullopt);
  EXPECT_NEAR(mailbox_.take(at(0)).pose.orientation.norm(), 1, kRounding_m);
}

TEST_F(StylusMailboxTest, PoseOutsideTheWorkspaceIsDropped) {
  expectDropped(poseAt(1000), Drop::kOutsideWorkspace);
  EXPECT_EQ(mailbox_.put(poseAt(0.999), nowhere, at(0)), std::nullopt);
}

TEST_F(StylusMailboxTest, DroppedPoseLeavesTheLastGoodOne) {
  mailbox_.put(poseAt(0.1), nowhere, at(0));
  mailbox_.put(poseAt(1000), nowhere, at(0.1));
  EXPECT_TRUE(mailbox_.take(at(0.15)).valid);
  EXPECT_FALSE(mailbox_.take(at(0.25)).valid);  // and does not keep it alive
}

TEST_F(StylusMailboxTest, PoseGoesStale) {
  mailbox_.put(poseAt(0.1), nowhere, at(0));
  EXPECT_TRUE(mailbox_.take(at(0.19)).valid);
  EXPECT_FALSE(mailbox_.take(at(0.21)).valid);
  EXPECT_TRUE(mailbox_.status(at(0.21)).stale);
  mailbox_.put(poseAt(0.1), nowhere, at(0.3));
  EXPECT_TRUE(mailbox_.take(at(0.31)).valid);
}

TEST_F(StylusMailboxTest, ButtonIsHeldUntilReleased) {
  mailbox_.put(0, joy({1}));
  EXPECT_TRUE(mailbox_.take(at(0)).button1);
  EXPECT_TRUE(mailbox_.take(at(0)).button1);
  EXPECT_FALSE(mailbox_.take(at(0)).button2);
  mailbox_.put(0, joy({0}));
  EXPECT_FALSE(mailbox_.take(at(0)).button1);
}

TEST_F(StylusMailboxTest, ClickIsAPressOfOneTick) {
  mailbox_.put(1, joy({2}));
  EXPECT_TRUE(mailbox_.take(at(0)).button2);
  EXPECT_FALSE(mailbox_.take(at(0)).button2);
}

TEST_F(StylusMailboxTest, PressBetweenTwoTicksIsNotLost) {
  mailbox_.put(0, joy({1}));
  mailbox_.put(0, joy({0}));
  EXPECT_TRUE(mailbox_.take(at(0)).button1);
  EXPECT_FALSE(mailbox_.take(at(0)).button1);
}

TEST_F(StylusMailboxTest, JoyWithoutOrWithStrangeButtonsIsDropped) {
  EXPECT_EQ(mailbox_.put(0, joy({})), Drop::kNoButtons);
  EXPECT_EQ(mailbox_.put(0, joy({3})), Drop::kButtonValue);
  EXPECT_EQ(mailbox_.put(0, joy({-1})), Drop::kButtonValue);
  EXPECT_FALSE(mailbox_.take(at(0)).button1);
}

}  // namespace
}  // namespace viscera::nodes
