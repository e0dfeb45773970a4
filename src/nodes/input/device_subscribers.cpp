// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/device_subscribers.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <omni_msgs/OmniButtonEvent.h>
#include <sensor_msgs/Joy.h>

#include "nodes/input/device_messages.h"

namespace viscera::nodes {
namespace {

constexpr uint32_t kDeviceSubscribersButtonQueue = 16;  ///< queue of events, which must not be dropped

DevicePose poseOf(const geometry_msgs::Pose& message) {
  return toDevicePose(message, ros::Time::now());
}
template <class Stamped>
DevicePose poseOf(const Stamped& message) {
  return toDevicePose(message);
}

ros::TransportHints promptly() {
  return ros::TransportHints().tcpNoDelay();
}

template <class Message>
ros::Subscriber listen(ros::NodeHandle& node, const PosePort& port, uint32_t queue, const PoseReceived& heard) {
  const boost::function<void(const ros::MessageEvent<const Message>&)> on_message =
      [heard](const ros::MessageEvent<const Message>& event) {
        heard(poseOf(*event.getConstMessage()), event.getPublisherName());
      };
  return node.subscribe<Message>(port.topic, queue, on_message, ros::VoidConstPtr(), promptly());
}

}  // namespace

ros::Subscriber listenToPoses(ros::NodeHandle& node, const PosePort& port, uint32_t queue, const PoseReceived& heard) {
  switch (port.type) {
    case PoseType::kPoseStamped:
      return listen<geometry_msgs::PoseStamped>(node, port, queue, heard);
    case PoseType::kTransformStamped:
      return listen<geometry_msgs::TransformStamped>(node, port, queue, heard);
    case PoseType::kPose:
      return listen<geometry_msgs::Pose>(node, port, queue, heard);
    case PoseType::kTf:
    case PoseType::kCrtkArm:
      break;
  }
  return {};
}

ros::Subscriber listenToButtons(ros::NodeHandle& node, const ButtonPort& port, const ButtonsReceived& heard) {
  if (port.type == ButtonType::kJoy) {
    const boost::function<void(const sensor_msgs::JoyConstPtr&)> on_joy =
        [heard](const sensor_msgs::JoyConstPtr& message) { heard(message->buttons); };
    return node.subscribe<sensor_msgs::Joy>(port.topic, kDeviceSubscribersButtonQueue, on_joy, ros::VoidConstPtr(),
                                            promptly());
  }
  if (port.type != ButtonType::kOmniButton) return {};
  using Event = omni_msgs::OmniButtonEvent;
  const boost::function<void(const boost::shared_ptr<const Event>&)> on_event =
      [heard](const boost::shared_ptr<const Event>& message) {
        heard({message->grey_button, message->white_button});
      };
  return node.subscribe<Event>(port.topic, kDeviceSubscribersButtonQueue, on_event, ros::VoidConstPtr(), promptly());
}

}  // namespace viscera::nodes
