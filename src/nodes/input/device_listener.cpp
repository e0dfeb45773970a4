// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/device_listener.h"

#include <ros/master.h>

#include <set>

#include "nodes/input/device_messages.h"
#include "nodes/input/device_subscribers.h"
#include "nodes/input/force_messages.h"
#include "viscera/math/error.h"

namespace viscera::nodes {
namespace {

constexpr uint32_t kQueue = 1000;  ///< queue of subscribers; messages must not be lost, since gaps are a finding
constexpr const char* kJoy = "sensor_msgs/Joy";
constexpr const char* kOmniButton = "omni_msgs/OmniButtonEvent";

const Vector3d forceOf(const geometry_msgs::Vector3& force) {
  return {force.x, force.y, force.z};
}
const Vector3d forceIn(const geometry_msgs::WrenchStamped& message) {
  return forceOf(message.wrench.force);
}
template <class Message>
const Vector3d forceIn(const Message& message) {
  return forceOf(message.force);
}

ros::master::V_TopicInfo published() {
  ros::master::V_TopicInfo topics;
  if (!ros::master::getTopics(topics)) throw Error("the ROS master does not list its topics");
  return topics;
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Returns the matching profile in config/devices, by the topic's name, its type, and related topics.
std::string profileOf(const PoseTopic& topic, const ros::master::V_TopicInfo& all) {
  const std::string name = topic.topic.substr(0, topic.topic.rfind('/'));
  const auto beside = [&](const std::string& end, const std::string& type) {
    for (const ros::master::TopicInfo& it : all)
      if (it.name == name + end && it.datatype == type) return true;
    return false;
  };
  const bool stamped = topic.type == PoseType::kTransformStamped;
  if (endsWith(topic.topic, "/measured_cp")) return (stamped ? "crtk_2021:" : "crtk:") + name;
  if (topic.type == PoseType::kPose) return "pose:" + name;
  if (stamped) return "vicon";
  if (beside("/button", kOmniButton)) return "phantom_omni:" + name;
  if (beside("/joy", kJoy)) return "geomagic:" + name;
  return "optitrack:" + name;
}

}  // namespace

std::vector<PoseTopic> poseTopics() {
  const ros::master::V_TopicInfo all = published();
  std::vector<PoseTopic> out;
  for (const ros::master::TopicInfo& it : all) {
    PoseTopic topic{it.name, PoseType::kPoseStamped, ""};
    if (it.datatype == "geometry_msgs/TransformStamped")
      topic.type = PoseType::kTransformStamped;
    else if (it.datatype == "geometry_msgs/Pose")
      topic.type = PoseType::kPose;
    else if (it.datatype != "geometry_msgs/PoseStamped")
      continue;
    topic.profile = profileOf(topic, all);
    out.push_back(topic);
  }
  return out;
}

DeviceListener::DeviceListener(ros::NodeHandle& node, const DeviceProfile& device, tf2_ros::Buffer& frames) {
  const PosePort& port = device.pose;
  if (port.type == PoseType::kTf)
    follower_ = std::make_unique<FrameFollower>(
        frames, port.tf_base, port.tf_frame,
        [this](const geometry_msgs::TransformStamped& newest) { onPose(toDevicePose(newest), true); });
  else
    poses_ = listenToPoses(node, port, kQueue,
                           [this, stamped = port.type != PoseType::kPose](const DevicePose& pose, const std::string&) {
                             onPose(pose, stamped);
                           });
  listenToAllButtons(node, device);
  withForceMessage(device.force.type, [&](auto message) {
    using Message = decltype(message);
    forces_ = node.subscribe<Message>(
        device.force.topic, kQueue,
        [this](const boost::shared_ptr<const Message>& received) { onForce(forceIn(*received)); });
  });
}

/// Subscribes to the buttons of the profile and to all others: the user may press another one.
void DeviceListener::listenToAllButtons(ros::NodeHandle& node, const DeviceProfile& device) {
  std::set<std::string> known;
  for (const ButtonPort& port : {device.button1, device.button2, device.clutch})
    if (port.type != ButtonType::kNone && known.insert(node.resolveName(port.topic)).second) listenTo(node, port);
  for (const ros::master::TopicInfo& topic : published()) {
    const bool joy = topic.datatype == kJoy;
    if ((joy || topic.datatype == kOmniButton) && known.insert(topic.name).second)
      listenTo(node, {joy ? ButtonType::kJoy : ButtonType::kOmniButton, topic.name, 0});
  }
}

void DeviceListener::listenTo(ros::NodeHandle& node, const ButtonPort& port) {
  buttons_.push_back(listenToButtons(node, port, [this, port](const std::vector<int32_t>& values) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (size_t i = 0; i < values.size() && open_ && heard_.buttons.size() < kMost; ++i)
      heard_.buttons.push_back({{port.type, port.topic, static_cast<int>(i)}, values[i]});
  }));
}

void DeviceListener::onPose(const DevicePose& pose, bool stamped) {
  received_pose_ = true;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!open_ || heard_.poses.size() >= kMost) return;
  ReceivedPose heard;
  heard.came_s = now();
  heard.clock_s = ros::Time::now().toSec();
  if (stamped) heard.stamp_s = pose.stamp.toSec();
  heard.pose = pose.pose;
  heard.frame = pose.frame;
  heard_.poses.push_back(heard);
}

void DeviceListener::onForce(const Vector3d& force_n) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (open_ && heard_.forces.size() < kMost) heard_.forces.push_back({now(), force_n});
}

void DeviceListener::begin() {
  const std::lock_guard<std::mutex> lock(mutex_);
  heard_ = {};
  begun_ = Clock::now();
  open_ = true;
}

DeviceListener::Heard DeviceListener::end() {
  const std::lock_guard<std::mutex> lock(mutex_);
  open_ = false;
  heard_.span_s = now();
  return heard_;
}

}  // namespace viscera::nodes
