// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/stylus_input.h"

#include <ros/console.h>

#include "nodes/conversions.h"

namespace viscera::nodes {
namespace {

constexpr uint32_t kButtonQueue = 16;  ///< events, none of which may be overtaken by a newer one

}  // namespace

StylusInput::StylusInput(const StylusConfig& config, const std::string& tissue_frame, const tf2_ros::Buffer& frames,
                         double max_transform_age_s)
    : frames_(frames),
      tissue_frame_(tissue_frame),
      max_transform_age_s_(max_transform_age_s),
      mailbox_(config, tissue_frame) {}

void StylusInput::subscribe(ros::NodeHandle& node) {
  const std::string& name = mailbox_.config().name;
  const auto hints = ros::TransportHints().tcpNoDelay();
  for (size_t i = 0; i < buttons_.size(); ++i)
    buttons_[i] = node.subscribe<sensor_msgs::Joy>(
        name + "/button" + std::to_string(i + 1), kButtonQueue,
        [this, i](const sensor_msgs::JoyConstPtr& message) { onButton(i, *message); }, ros::VoidConstPtr(), hints);
  pose_ = node.subscribe(name + "/measured_cp", 1, &StylusInput::onPose, this, hints);
  subscribed_ = true;
}

void StylusInput::onPose(const ros::MessageEvent<const geometry_msgs::PoseStamped>& event) {
  const geometry_msgs::PoseStamped& message = *event.getConstMessage();
  if (senders_.note(event.getPublisherName(), std::chrono::steady_clock::now()))
    ROS_WARN("%s/measured_cp: several nodes send poses, the tool jumps between them: %s",
             mailbox_.config().name.c_str(), rivals().c_str());
  const auto lookup = [this](const std::string& frame) { return inTissue(frame); };
  const Arrival now{std::chrono::steady_clock::now(), ros::Time::now()};
  const std::optional<Drop> reason = mailbox_.put(message, lookup, now);
  const std::string frames = ": '" + message.header.frame_id + "' to '" + tissue_frame_ + "'";
  warn("measured_cp", reason, reason == Drop::kNoTransform || reason == Drop::kOldTransform ? frames : "");
}

void StylusInput::onButton(size_t button, const sensor_msgs::Joy& message) {
  warn("button" + std::to_string(button + 1), mailbox_.put(button, message, std::chrono::steady_clock::now()));
}

FramePlace StylusInput::inTissue(const std::string& frame) const {
  try {
    // The newest transform: waiting for the one of the pose's stamp would delay the hand by a tf period.
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
  if (!reason || warned_[static_cast<size_t>(*reason)]) return;
  warned_[static_cast<size_t>(*reason)] = true;
  ROS_WARN("%s/%s: a message was dropped (%s%s); later ones are counted in /diagnostics",
           mailbox_.config().name.c_str(), topic.c_str(), text(*reason), detail.c_str());
}

}  // namespace viscera::nodes
