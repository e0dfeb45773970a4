// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/stylus_marker.h"

#include <ros/console.h>
#include <ros/spinner.h>

#include "nodes/conversions.h"
#include "nodes/stylus_mailbox.h"

namespace viscera::nodes {
namespace {

using visualization_msgs::InteractiveMarker;
using visualization_msgs::InteractiveMarkerControl;
using visualization_msgs::InteractiveMarkerFeedback;
using visualization_msgs::Marker;

constexpr float kSize_m = 0.05F;  ///< of the arrows and rings: they clear an organ of a hand's size
constexpr double kBall_m = 0.03;  ///< what the mouse grips: larger than the tips that are drawn in it
constexpr const char* kName = "stylus";

Marker ball() {
  Marker marker;
  marker.type = Marker::SPHERE;
  marker.scale.x = marker.scale.y = marker.scale.z = kBall_m;
  marker.color.r = 1;
  marker.color.g = 0.8F;
  marker.color.b = 0.2F;
  marker.color.a = 0.3F;
  return marker;
}

/// Along (and about) the axis that a quaternion turns x into.
InteractiveMarkerControl control(uint8_t mode, const std::string& name, const Vector3d& axis) {
  InteractiveMarkerControl out;
  out.name = name;
  out.interaction_mode = mode;
  const Quaterniond turn = Quaterniond::FromTwoVectors(Vector3d::UnitX(), axis);
  out.orientation.x = turn.x();
  out.orientation.y = turn.y();
  out.orientation.z = turn.z();
  out.orientation.w = turn.w();
  return out;
}

InteractiveMarker markerAt(const Pose& pose, const SteeringOptions& options) {
  InteractiveMarker marker;
  marker.header.frame_id = options.frame;
  marker.name = kName;
  marker.description = options.stylus;
  marker.scale = kSize_m;
  marker.pose = toMessage(pose);
  InteractiveMarkerControl grip = control(InteractiveMarkerControl::MOVE_ROTATE_3D, "grip", Vector3d::UnitX());
  grip.always_visible = true;
  grip.markers.push_back(ball());
  marker.controls.push_back(grip);
  const Vector3d axes[] = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  for (size_t i = 0; i < 3; ++i) {
    const std::string name(1, static_cast<char>('x' + i));
    marker.controls.push_back(control(InteractiveMarkerControl::MOVE_AXIS, "move " + name, axes[i]));
    marker.controls.push_back(control(InteractiveMarkerControl::ROTATE_AXIS, "turn " + name, axes[i]));
  }
  return marker;
}

}  // namespace

SteeringOptions markerOptions(Parameters& parameters) {
  const SteeringOptions options = SteeringOptions::read(parameters);
  parameters.refuseOthers();
  return options;
}

StylusMarker::StylusMarker(const SteeringOptions& options)
    : options_(options),
      device_(node_, options.stylus),
      server_(node_.resolveName(options.stylus + "/marker")),
      target_(options.start),
      pose_(options.start) {
  server_.insert(markerAt(target_, options_), [this](const Feedback& feedback) { onMoved(feedback); });
  makeMenu();
  menu_.apply(server_, kName);
  server_.applyChanges();
}

void StylusMarker::makeMenu() {
  const auto add = [this](const std::string& title, bool& button) {
    const Menu::EntryHandle entry =
        menu_.insert(title, [this, &button](const Feedback& feedback) { toggle(feedback->menu_entry_id, button); });
    menu_.setCheckState(entry, Menu::UNCHECKED);
  };
  add("Button 1", button1_);
  add("Button 2", button2_);
  menu_.insert("Back to the start", [this](const Feedback&) { goBack(); });
}

void StylusMarker::run() {
  ros::AsyncSpinner spinner(1);
  spinner.start();
  ROS_INFO(
      "rviz: add InteractiveMarkers with the topic %s/marker/update; the right mouse button on the ball has the "
      "buttons",
      node_.resolveName(options_.stylus).c_str());
  playSteadily(options_, device_, [this](double dt_s) { return next(dt_s); });
}

void StylusMarker::onMoved(const Feedback& feedback) {
  if (feedback->event_type != InteractiveMarkerFeedback::POSE_UPDATE) return;
  Pose pose = fromMessage(feedback->pose);
  const bool good = isFinite(pose) && isUnit(pose.orientation);
  if (!good || feedback->header.frame_id != options_.frame) {
    ROS_WARN_THROTTLE(5, "%s/marker/feedback: a pose was dropped: it is not finite, or its frame '%s' is not '%s'",
                      options_.stylus.c_str(), feedback->header.frame_id.c_str(), options_.frame.c_str());
    return;
  }
  pose.orientation.normalize();
  const std::lock_guard<std::mutex> lock(mutex_);
  target_ = within(pose, options_.start.position_m, options_.reach_m);
}

void StylusMarker::toggle(Menu::EntryHandle entry, bool& button) {
  const std::lock_guard<std::mutex> lock(mutex_);
  button = !button;
  menu_.setCheckState(entry, button ? Menu::CHECKED : Menu::UNCHECKED);
  menu_.reApply(server_);
  server_.applyChanges();
}

void StylusMarker::goBack() {
  const std::lock_guard<std::mutex> lock(mutex_);
  target_ = options_.start;
  server_.setPose(kName, toMessage(target_));
  server_.applyChanges();
}

StylusSample StylusMarker::next(double dt_s) {
  const std::lock_guard<std::mutex> lock(mutex_);
  pose_ = approach(pose_, target_, options_.speed, dt_s);
  return {true, pose_, button1_, button2_};
}

}  // namespace viscera::nodes
