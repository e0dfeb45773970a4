// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/markers/needle_publisher.h"

#include <gtest/gtest.h>

namespace viscera::nodes {
namespace {

TEST(Needles, ArePublishedWithTheirSuturesAndWhoHoldsThem) {
  Scene scene;
  scene.environment.tissue_frame = "room/tissue";
  scene.styluses.resize(2);
  scene.styluses[1].name = "right";
  scene.sutures.resize(3);
  scene.sutures[0].name = "first";
  scene.sutures[2].name = "third";
  Frame frame;
  frame.tick = 7;
  frame.needles = {{2, Pose{{0.1, 0.2, 0.3}, Quaterniond::Identity()}, 0.006, 3, 0.0004, 1, true},
                   {0, Pose{}, 0.008, 2, 0.0003, layout::kMaxStyluses, false}};
  const Needles message = toNeedles(frame, scene, ros::Time(3));
  EXPECT_EQ(message.header.frame_id, "room/tissue");
  EXPECT_EQ(message.header.stamp, ros::Time(3));
  EXPECT_EQ(message.tick, 7U);
  EXPECT_EQ(message.sutures, (std::vector<std::string>{"third", "first"}));
  EXPECT_EQ(message.held_by, (std::vector<std::string>{"right", ""}));
  EXPECT_EQ(message.poses.at(0).position.z, 0.3);
  EXPECT_EQ(message.radii_m, (std::vector<double>{0.006, 0.008}));
  EXPECT_EQ(message.arcs_rad, (std::vector<double>{3, 2}));
  EXPECT_EQ(message.wire_radii_m, (std::vector<double>{0.0004, 0.0003}));
  EXPECT_TRUE(message.in_tissue.at(0));
  EXPECT_FALSE(message.in_tissue.at(1));
}

}  // namespace
}  // namespace viscera::nodes
