// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/frame_listener.h"

#include <gtest/gtest.h>

namespace viscera::nodes {
namespace {

constexpr double kAt_m = 0.25;

tf2_msgs::TFMessage message(double stamp_s, const std::string& child = "tracker") {
  tf2_msgs::TFMessage out;
  geometry_msgs::TransformStamped& frame = out.transforms.emplace_back();
  frame.header.stamp = ros::Time(stamp_s);
  frame.header.frame_id = "world";
  frame.child_frame_id = child;
  frame.transform.translation.x = kAt_m;
  frame.transform.rotation.w = 1;
  return out;
}

bool knows(const tf2::BufferCore& frames, double at_s, const std::string& child = "tracker") {
  return frames.canTransform("world", child, ros::Time(at_s));
}

TEST(FrameIntake, TakesWhatOthersSend) {
  tf2::BufferCore frames;
  FrameIntake intake(frames, "/simulator");
  intake.take(message(1000), "/tracker", ros::Time(1000), false);
  EXPECT_TRUE(knows(frames, 1000));
}

TEST(FrameIntake, LeavesOutItsOwnMovingFramesAndKeepsItsFixedOnes) {
  tf2::BufferCore frames;
  FrameIntake intake(frames, "/simulator");
  intake.take(message(1000, "left_tool"), "/simulator", ros::Time(1000), false);
  intake.take(message(1000, "tissue"), "/simulator", ros::Time(1000), true);
  EXPECT_FALSE(knows(frames, 1000, "left_tool"));
  EXPECT_TRUE(knows(frames, 1000, "tissue"));
  FrameIntake of_all(frames, "");
  of_all.take(message(1000, "left_tool"), "/simulator", ros::Time(1000), false);
  of_all.take(message(1000, "unnamed"), "", ros::Time(1000), false);
  EXPECT_TRUE(knows(frames, 1000, "unnamed")) << "where none is left out, a sender without a name is not";
  EXPECT_TRUE(knows(frames, 1000, "left_tool"));
}

TEST(FrameIntake, AfterAClockThatWentBackAMessageOfBeforeKeepsNoLaterOneOut) {
  ros::Time::init();  // for the log
  tf2::BufferCore frames;
  FrameIntake intake(frames, "/simulator");
  intake.take(message(1000, "tissue"), "/simulator", ros::Time(1000), true);
  intake.take(message(1000), "/tracker", ros::Time(1000), false);
  intake.take(message(1000.1), "/tracker", ros::Time(900), false);  // in transit when the clock went back
  EXPECT_FALSE(knows(frames, 1000));
  EXPECT_TRUE(knows(frames, 900, "tissue")) << "what is fixed stays";
  intake.take(message(900.1), "/tracker", ros::Time(900.1), false);
  EXPECT_TRUE(knows(frames, 900.1));
}

TEST(FrameIntake, AStampALittleAheadIsAccepted) {
  tf2::BufferCore frames;
  FrameIntake intake(frames, "");
  intake.take(message(1001), "/localiser", ros::Time(1000), false);  // such as predictions of future poses
  EXPECT_TRUE(knows(frames, 1001));
}

}  // namespace
}  // namespace viscera::nodes
