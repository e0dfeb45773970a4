// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/stylus_input.h"

#include <ros/console.h>

#include "nodes/input/device_messages.h"
#include "nodes/input/device_subscribers.h"
#include "nodes/ros/conversions.h"

namespace viscera::nodes {
namespace {

ros::TransportHints stylusInputPromptly() {
  return ros::TransportHints().tcpNoDelay();
}

}  // namespace

StylusInput::StylusInput(const StylusConfig& config, const DeviceProfile& device, const std::string& tissue_frame,
                         tf2_ros::Buffer& frames, double max_transform_age_s)
    : frames_(frames),
      tissue_frame_(tissue_frame),
      max_transform_age_s_(max_transform_age_s),
      mailbox_(config, tissue_frame, device) {
  if (device.pose.type == PoseType::kCrtkArm) arm_ = std::make_unique<CrtkArm>(mailbox_);
}

void StylusInput::subscribe(ros::NodeHandle& node) {
  const DeviceProfile& device = mailbox_.device();
  const PosePort& port = device.pose;
  listenTo(node, device.button1, ButtonRole::kButton1);
  listenTo(node, device.button2, ButtonRole::kButton2);
  listenTo(node, device.clutch, ButtonRole::kClutch);
  if (arm_) {
    arm_->subscribe(node, [this](const std::string& frame) {
      return frame == tissue_frame_ ? FramePose{Pose{}} : inTissue(frame);
    });
  } else if (port.type == PoseType::kTf) {
    follower_ =
        std::make_unique<FrameFollower>(frames_, port.tf_base, port.tf_frame,
                                        [this](const geometry_msgs::TransformStamped& newest) { onTransform(newest); });
  } else {
    pose_ = listenToPoses(node, port, 1, [this](const DevicePose& pose, const std::string& sender) {
      const std::string& topic = mailbox_.device().pose.topic;
      if (senders_.record(sender, std::chrono::steady_clock::now()))
        ROS_WARN("%s: several nodes send poses, and the tool jumps between them: %s", topic.c_str(), rivals().c_str());
      onPose(pose, topic);
    });
  }
  if (!arm_) {
    listenToGripper(node);
    jaw_ = node.advertise<sensor_msgs::JointState>(mailbox_.config().name + "/jaw/measured_js", 1);
  }
  subscribed_ = true;
}

void StylusInput::unsubscribe() {
  subscribed_ = false;
  pose_.shutdown();
  for (ros::Subscriber& other : others_) other.shutdown();
}

void StylusInput::listenTo(ros::NodeHandle& node, const ButtonPort& port, ButtonRole role) {
  others_.push_back(listenToButtons(
      node, port, [this, &port, role](const std::vector<int32_t>& values) { onButtons(port, role, values); }));
}

void StylusInput::onTransform(const geometry_msgs::TransformStamped& newest) {
  const std::string& frame = mailbox_.device().pose.tf_frame;
  if (isOlder(newest, max_transform_age_s_)) {
    warn(frame, mailbox_.drop(Drop::kOldTransform));
  } else {
    onPose(toDevicePose(newest), frame);
  }
}

void StylusInput::listenToGripper(ros::NodeHandle& node) {
  const GripperPort& port = mailbox_.device().gripper;
  if (port.presses == PressedButton::kNone) return;
  others_.push_back(node.subscribe<sensor_msgs::JointState>(
      port.topic, 1, [this](const sensor_msgs::JointStateConstPtr& message) { onGripper(*message); },
      ros::VoidConstPtr(), stylusInputPromptly()));
}

void StylusInput::onPose(const DevicePose& pose, const std::string& topic) {
  const auto lookup = [this](const std::string& frame) { return inTissue(frame); };
  const Arrival now{std::chrono::steady_clock::now(), ros::Time::now()};
  const std::optional<Drop> reason = mailbox_.put(pose, lookup, now);
  const PosePort& port = mailbox_.device().pose;
  const std::string frame = port.frame.empty() ? pose.frame : port.frame;
  std::string detail;
  if (reason == Drop::kNoTransform || reason == Drop::kOldTransform)
    detail = ": '" + frame + "' to '" + tissue_frame_ + "'";
  if (reason == Drop::kOutsideWorkspace && port.unit_m == 1)
    detail = ": if this device sends millimetres, set pose.unit_m: 0.001 in its profile";
  warn(topic, reason, detail);
  const uint64_t moves = mailbox_.baseMoves();
  if (moves != reported_base_moves_)
    ROS_WARN_THROTTLE(
        5, "%s: the frame '%s' was moved; the stylus is tracked from the start, and its buttons must be released first",
        topic.c_str(), frame.c_str());
  reported_base_moves_ = moves;
}

void StylusInput::onButtons(const ButtonPort& port, ButtonRole role, const std::vector<int32_t>& values) {
  const uint64_t ignored = mailbox_.buttonPressesIgnored();
  warn(port.topic, mailbox_.press(role, values, static_cast<size_t>(port.index), std::chrono::steady_clock::now()));
  if (role == ButtonRole::kClutch) return;
  warnOfIgnored(port.topic, role == ButtonRole::kButton1 ? PressedButton::kButton1 : PressedButton::kButton2, ignored);
}

void StylusInput::onGripper(const sensor_msgs::JointState& message) {
  const GripperPort& port = mailbox_.device().gripper;
  const size_t joint = static_cast<size_t>(port.index);
  const uint64_t ignored = mailbox_.buttonPressesIgnored();
  warn(port.topic, mailbox_.grip(message.position, joint, std::chrono::steady_clock::now()));
  warnOfIgnored(port.topic, port.presses, ignored);
}

/// Warns once for each time that a press is ignored.
void StylusInput::warnOfIgnored(const std::string& topic, PressedButton button, uint64_t ignored_before) {
  if (button != PressedButton::kButton1 && button != PressedButton::kButton2) return;
  const bool ignored = mailbox_.buttonPressesIgnored() != ignored_before;
  bool& warned = warned_ignored_[button == PressedButton::kButton2];
  if (ignored && !warned)
    ROS_WARN(
        "%s: this press was ignored: the stylus was not tracked yet, or the button was down when tracking began. "
        "Release it and press again",
        topic.c_str());
  warned = ignored;
}

void StylusInput::beginTick() {
  if (arm_) arm_->beginTick();
}

void StylusInput::endTick(const StylusMotion& tool, double jaw_moment_nm, const ros::Time& stamp) {
  if (!subscribed_) return;
  if (arm_) return arm_->endTick(tool, jaw_moment_nm, stamp);
  if (jaw_.getNumSubscribers() > 0 && hasJaws(tool)) jaw_.publish(toJaw(tool, jaw_moment_nm, stamp));
}

bool StylusInput::hasPublisher() const {
  if (!subscribed_) return false;
  if (arm_) return arm_->hasClient();
  return follower_ ? follower_->found() : pose_.getNumPublishers() > 0;
}

FramePose StylusInput::inTissue(const std::string& frame) const {
  try {
    // The newest transform: waiting for the one at the pose's stamp would add a delay of one tf period.
    const geometry_msgs::TransformStamped newest = frames_.lookupTransform(tissue_frame_, frame, ros::Time(0));
    if (isOlder(newest, max_transform_age_s_)) return {std::nullopt, true};
    Pose pose = fromMessage(newest.transform);
    pose.orientation.normalize();
    return {pose};
  } catch (const tf2::TransformException&) {
    return {};
  }
}

void StylusInput::warn(const std::string& topic, std::optional<Drop> reason, const std::string& detail) {
  if (!reason || warned_[static_cast<size_t>(*reason)].exchange(true)) return;
  ROS_WARN("%s: a message was dropped (%s%s); later ones are counted in /diagnostics", topic.c_str(), text(*reason),
           detail.c_str());
}

}  // namespace viscera::nodes
