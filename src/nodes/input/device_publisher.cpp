// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/device_publisher.h"

#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>

#include <utility>

#include "nodes/ros/conversions.h"

namespace viscera::nodes {
namespace {

constexpr uint32_t kButtonQueue = 16;

void sendButton(const ros::Publisher& publisher, bool pressed, const ros::Time& stamp) {
  sensor_msgs::Joy message;
  message.header.stamp = stamp;
  message.buttons = {pressed ? 1 : 0};
  publisher.publish(message);
}

}  // namespace

DevicePublisher::DevicePublisher(ros::NodeHandle& node, const std::string& stylus)
    : pose_(node.advertise<geometry_msgs::PoseStamped>(stylus + "/measured_cp", 1)),
      button1_(node.advertise<sensor_msgs::Joy>(stylus + "/button1", kButtonQueue)),
      button2_(node.advertise<sensor_msgs::Joy>(stylus + "/button2", kButtonQueue)),
      gripper_(node.advertise<sensor_msgs::JointState>(stylus + "/gripper/measured_js", 1)) {}

bool DevicePublisher::isReceived() const {
  return pose_.getNumSubscribers() > 0 && button1_.getNumSubscribers() > 0 && button2_.getNumSubscribers() > 0;
}

void DevicePublisher::send(const StylusSample& sample, const std::string& frame, const ros::Time& stamp) {
  geometry_msgs::PoseStamped pose;
  pose.header.frame_id = frame;
  pose.header.stamp = stamp;
  pose.pose = toMessage(sample.pose);
  pose_.publish(pose);
  if (sample.jaw_rad >= 0) {
    sensor_msgs::JointState gripper;
    gripper.header.stamp = stamp;
    gripper.name = {"gripper"};
    gripper.position = {sample.jaw_rad};
    gripper_.publish(gripper);
  }
  const bool begins = !std::exchange(begun_, true);
  const bool down1 = sample.button1 && !begins, down2 = sample.button2 && !begins;
  if (begins || down1 != button1_down_) sendButton(button1_, down1, stamp);
  if (begins || down2 != button2_down_) sendButton(button2_, down2, stamp);
  button1_down_ = down1;
  button2_down_ = down2;
}

}  // namespace viscera::nodes
