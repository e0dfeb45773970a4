// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulated_devices/stylus_marker.h"

#include <ros/console.h>
#include <ros/spinner.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "nodes/input/stylus_check.h"
#include "nodes/input/stylus_mailbox.h"
#include "nodes/ros/conversions.h"

namespace viscera::nodes {
namespace {

constexpr const char* kName = "stylus";
constexpr const char* kSwitches[] = {"idle", "button1", "button2"};  ///< names in the diagnostics
constexpr double kTimer_s = 0.2;                                     ///< period of the distance [s]
constexpr std::chrono::seconds kSilence{3};          ///< rviz sends four messages a second during a drag
constexpr std::chrono::seconds kPatience{3};         ///< time without a simulator before a warning
constexpr double kSizeOfOrgan = 0.3;                 ///< size of the arrows relative to the organ's longest side
constexpr double kLeast_m = 0.015, kMost_m = 0.035;  ///< limits of these arrows [m]
constexpr double kReachOfOrgan = 1.2;                ///< reach relative to the distance of the organ's far end
constexpr double kLetter_m = 0.006;                  ///< height of a letter [m]
const Vector3d kTextAt(0, -1.1, 1.2);                ///< in sizes of the marker: next to the shaft, outside the organ

/// Returns `start`, moved by a share of the motion between two poses.
Pose moved(const Pose& from, const Pose& to, double share, const Pose& start) {
  const Quaterniond turn = Quaterniond::Identity().slerp(share, to.orientation * from.orientation.conjugate());
  return {start.position_m + share * (to.position_m - from.position_m), (turn * start.orientation).normalized()};
}

}  // namespace

MarkerOptions markerOptions(Parameters& parameters) {
  MarkerOptions options;
  options.has_start = parameters.has("start");
  options.has_reach = parameters.has("reach_m");
  options.steering = SteeringOptions::read(parameters);
  options.coarse_step_m = parameters.number("coarse_step_m", options.coarse_step_m, 1e-6, 0.1);
  options.fine_step_m = parameters.number("fine_step_m", options.fine_step_m, 1e-6, 0.1);
  parameters.refuseOthers();
  if (options.fine_step_m > options.coarse_step_m)
    throw ParameterError("parameter ~fine_step_m: must not be more than ~coarse_step_m");
  return options;
}

StylusMarker::StylusMarker(const MarkerOptions& options)
    : options_(options),
      device_(node_, options.steering.stylus),
      server_(node_.resolveName(options.steering.stylus + "/marker")) {
  style_.stylus = options_.steering.stylus;
  style_.frame = options_.steering.frame;
  if (options_.has_start) {
    target_ = pose_ = options_.steering.start;
    placed_ = true;
  }
  text_ = node_.advertise<visualization_msgs::Marker>(style_.stylus + "/marker/text", 1);
  diagnostics_ = node_.subscribe("/diagnostics", 100, &StylusMarker::onDiagnostics, this);
  stale_ = placed_;
  timer_ = node_.createSteadyTimer(ros::WallDuration(kTimer_s), [this](const ros::SteadyTimerEvent&) { onTimer(); });
}

void StylusMarker::run() {
  ros::AsyncSpinner spinner(1);
  spinner.start();
  ROS_INFO(
      "rviz: add InteractiveMarkers with the topic %s/marker/update; the right mouse button on the ball has the "
      "buttons",
      node_.resolveName(style_.stylus).c_str());
  playSteadily(options_.steering, device_, [this](double dt_s) { return next(dt_s); });
}

void StylusMarker::onTimer() {
  bool placed, dragged;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (drag_ && Clock::now() - drag_->heard > kSilence) drag_.reset();  // rviz has ended: the button is released
    placed = placed_;
    dragged = drag_.has_value();
  }
  watchSurface(!placed || text_.getNumSubscribers() > 0);
  if (!placed) return place();
  if (stale_ && !dragged) show();  // showing the marker again would end a drag
  if (text_.getNumSubscribers() > 0) text_.publish(textNow());
}

/// Subscribes to the surface only while needed: with a subscriber the simulator computes every surface.
void StylusMarker::watchSurface(bool wanted) {
  if (wanted == static_cast<bool>(surface_)) return;
  newest_.reset();
  if (!wanted) {
    surface_.shutdown();
    topology_.shutdown();
    surface_ = topology_ = ros::Subscriber();
    return;
  }
  surface_ = node_.subscribe<SurfaceVertices>("surface", 1, [this](const auto& message) { newest_ = message; });
  topology_ = node_.subscribe<SurfaceTopology>("surface_topology", 1,
                                               [this](const auto& message) { skin_.triangles = message->triangles; });
}

/// Places the marker in front of the organ, as soon as the organ is known.
void StylusMarker::place() {
  if (!takeSkin()) {
    if (warned_ || Clock::now() - begun_ < kPatience || surface_.getNumPublishers() > 0) return;
    warned_ = true;
    ROS_WARN("no simulator sends %s, in front of which stylus %s starts; it waits. Set ~start to give its pose",
             surface_.getTopic().c_str(), style_.stylus.c_str());
    return;
  }
  const Pose start = startNow();
  const std::lock_guard<std::mutex> lock(mutex_);
  target_ = pose_ = start;
  placed_ = stale_ = true;
}

/// Takes the newest surface. @returns whether there is one in the frame of the poses
bool StylusMarker::takeSkin() {
  if (!newest_ || newest_->positions_m.empty()) return false;
  const std::string& frame = newest_->header.frame_id;
  if (frame != style_.frame) {
    ROS_WARN_THROTTLE(60, "%s is in the frame '%s', but ~frame is '%s'; set ~start to the pose where stylus %s starts",
                      surface_.getTopic().c_str(), frame.c_str(), style_.frame.c_str(), style_.stylus.c_str());
    return false;
  }
  skin_.points_m = newest_->positions_m;
  return true;
}

/// Returns the initial pose, and sets what depends on the organ's size.
Pose StylusMarker::startNow() {
  if (skin_.empty()) return options_.steering.start;
  const Eigen::AlignedBox3d box = skin_.box();
  style_.size_m = std::clamp(kSizeOfOrgan * box.sizes().maxCoeff(), kLeast_m, kMost_m);
  if (options_.has_start) return options_.steering.start;
  const Pose start = startBefore(skin_, sideOfTool(style_.stylus == "left"));
  const double reach_m = kReachOfOrgan * ((start.position_m - box.center()).norm() + box.sizes().norm() / 2);
  const std::lock_guard<std::mutex> lock(mutex_);
  options_.steering.start = start;
  if (!options_.has_reach) options_.steering.reach_m = std::max(options_.steering.reach_m, reach_m);
  return start;
}

void StylusMarker::onDiagnostics(const diagnostic_msgs::DiagnosticArray& message) {
  for (const diagnostic_msgs::DiagnosticStatus& status : message.status) {
    if (stylusReport(status) != style_.stylus) continue;
    for (const diagnostic_msgs::KeyValue& value : status.values)
      for (size_t i = 0; i < style_.modes.size(); ++i)
        if (value.key == kSwitches[i] && std::exchange(style_.modes[i], value.value) != value.value) stale_ = true;
  }
}

void StylusMarker::show() {
  stale_ = false;
  style_.step_m = step_m();
  Pose target;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    target = target_;
  }
  server_.insert(markerOf(style_, target), [this](const Feedback& feedback) { onFeedback(*feedback); });
  makeMenu();
  menu_.apply(server_, kName);
  server_.applyChanges();
}

void StylusMarker::makeMenu() {
  menu_ = Menu();
  const auto add = [this](const std::string& title, bool& checked) {
    const Menu::EntryHandle entry = menu_.insert(title, [this, &checked](const Feedback&) {
      const std::lock_guard<std::mutex> lock(mutex_);
      checked = !checked;
      stale_ = true;
    });
    menu_.setCheckState(entry, checked ? Menu::CHECKED : Menu::UNCHECKED);
  };
  for (size_t button : {1, 2})
    if (style_.shows(button)) add(style_.menuNameOf(button), checked_[button]);
  add("Fine: steps of " + lengthText(options_.fine_step_m) + " instead of " + lengthText(options_.coarse_step_m) +
          ", drags scaled alike",
      fine_);
  menu_.insert("Back to the start", [this](const Feedback&) { goTo(startNow()); });
}

void StylusMarker::onFeedback(const Message& feedback) {
  switch (feedback.event_type) {
    case Message::MOUSE_DOWN: {
      const std::lock_guard<std::mutex> lock(mutex_);
      drag_ = Drag{target_, target_, pressOf(feedback.control_name), Clock::now()};
      break;
    }
    case Message::POSE_UPDATE:
      onMoved(feedback);
      break;
    case Message::KEEP_ALIVE: {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (drag_) drag_->heard = Clock::now();
      break;
    }
    case Message::MOUSE_UP:
      letGo();
      break;
    case Message::BUTTON_CLICK:
      if (feedback.control_name == kForward) step(step_m());
      if (feedback.control_name == kBack) step(-step_m());
      break;
    default:
      break;
  }
}

void StylusMarker::onMoved(const Message& feedback) {
  // after a click rviz reports the marker's pose before the step
  if (feedback.control_name == kForward || feedback.control_name == kBack) return;
  Pose pose = fromMessage(feedback.pose);
  if (!isFinite(pose) || !isUnit(pose.orientation) || feedback.header.frame_id != style_.frame) {
    ROS_WARN_THROTTLE(5, "%s/marker/feedback: a pose was dropped: it is invalid, or its frame '%s' is not '%s'",
                      style_.stylus.c_str(), feedback.header.frame_id.c_str(), style_.frame.c_str());
    return;
  }
  pose.orientation.normalize();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!drag_) drag_ = Drag{target_, target_, 0, {}};
  drag_->heard = Clock::now();
  if (fine_) pose = moved(drag_->marker, pose, options_.fine_step_m / options_.coarse_step_m, drag_->target);
  target_ = within(pose, options_.steering.start.position_m, options_.steering.reach_m);
}

/// Moves the ball to the tip, which is behind the mouse in fine steps and at the limit of its reach.
void StylusMarker::letGo() {
  Pose target;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    drag_.reset();
    target = target_;
  }
  goTo(target);
}

/// Steps along the shaft: the blade is ahead of it.
void StylusMarker::step(double forward_m) {
  Pose target;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    target = target_;
  }
  target.position_m -= forward_m * (target.orientation * Vector3d::UnitZ());
  goTo(within(target, options_.steering.start.position_m, options_.steering.reach_m));
}

void StylusMarker::goTo(const Pose& target) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    target_ = target;
  }
  server_.setPose(kName, toMessage(target));
  server_.applyChanges();
}

visualization_msgs::Marker StylusMarker::textNow() {
  Pose tip;
  bool pressed[3] = {};
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    tip = pose_;
    for (size_t button : {1, 2}) pressed[button] = isPressed(button);
  }
  const size_t acts = pressed[1] ? 1 : pressed[2] ? 2 : 0;
  std::string text = style_.modes[acts].empty() ? style_.stylus : style_.modes[acts];
  const std::optional<double> away_m = takeSkin() ? distanceToSkin(skin_, tip.position_m) : std::nullopt;
  if (away_m) text += ", " + lengthText(std::abs(*away_m)) + (*away_m < 0 ? " under the skin" : " from the skin");
  visualization_msgs::Marker marker;
  marker.header.frame_id = style_.frame;
  marker.ns = style_.stylus;
  marker.type = visualization_msgs::Marker::TEXT_VIEW_FACING;
  marker.pose = toMessage(Pose{tip * (style_.size_m * kTextAt), Quaterniond::Identity()});
  marker.scale.z = kLetter_m;
  marker.color.r = marker.color.g = marker.color.b = marker.color.a = 1;
  marker.text = text;
  return marker;
}

bool StylusMarker::isPressed(size_t button) const {
  return checked_[button] || (drag_ && drag_->presses == static_cast<int>(button));
}

StylusSample StylusMarker::next(double dt_s) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!placed_) return {};
  pose_ = approach(pose_, target_, options_.steering.speed, dt_s);
  return {true, pose_, isPressed(1), isPressed(2)};
}

}  // namespace viscera::nodes
