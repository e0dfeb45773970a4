// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/stylus_mailbox.h"

#include <algorithm>
#include <cmath>

#include "nodes/conversions.h"

namespace viscera::nodes {
namespace {

/// Joy messages of a driver that repeats them come within this of its first pose.
constexpr std::chrono::milliseconds kFirstButtons{250};
/// A device that was silent for so long may come back with another clock.
constexpr std::chrono::seconds kNewClock{5};

/// From stamp to arrival. Not by ros::Duration, which throws where the two are 68 years apart.
double delay_s(const ros::Time& stamp, const Arrival& now) {
  return now.ros.toSec() - stamp.toSec();
}

/// tf2 refuses names with a leading slash, which drivers older than tf2 still send.
std::string tf2Name(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

}  // namespace

const char* text(Drop reason) {
  static constexpr std::array<const char*, kDropReasons> kNames = {
      "stamp_zero",     "not_finite", "bad_quaternion",    "no_transform", "old_transform",
      "repeated_stamp", "delayed",    "outside_workspace", "no_buttons",   "button_value"};
  return kNames[static_cast<size_t>(reason)];
}

StylusMailbox::StylusMailbox(const StylusConfig& config, const std::string& tissue_frame)
    : config_(config), tissue_frame_(tissue_frame) {
  device_frame_.name = tissue_frame;
}

std::optional<Drop> StylusMailbox::drop(Drop reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++status_.dropped[static_cast<size_t>(reason)];
  return reason;
}

std::optional<Drop> StylusMailbox::put(const geometry_msgs::PoseStamped& message, const FrameLookup& lookup,
                                       const Arrival& now) {
  const ros::Time& stamp = message.header.stamp;
  if (stamp.isZero()) return drop(Drop::kStampZero);
  Pose in_device = fromMessage(message.pose);
  if (!isFinite(in_device)) return drop(Drop::kNotFinite);
  // negated, so that an overflow of the norm is refused too
  if (!(std::abs(in_device.orientation.norm() - 1) <= kQuaternionTolerance)) return drop(Drop::kBadQuaternion);
  in_device.orientation.normalize();

  const std::string& named = message.header.frame_id;
  const std::string frame = named.empty() ? tissue_frame_ : tf2Name(named);
  const FramePlace place = frame == tissue_frame_ ? FramePlace{Pose{}} : lookup(frame);
  if (!place.in_tissue) return drop(place.too_old ? Drop::kOldTransform : Drop::kNoTransform);
  const Pose in_tissue = *place.in_tissue * in_device;
  if (!isFinite(in_tissue)) return drop(Drop::kNotFinite);
  if (!(in_tissue.position_m.norm() <= config_.workspace_m)) return drop(Drop::kOutsideWorkspace);

  const std::lock_guard<std::mutex> lock(mutex_);
  if (const std::optional<Drop> late = checkStamp(stamp, now)) {
    ++status_.dropped[static_cast<size_t>(*late)];
    return late;
  }
  noteStamp(stamp, now);
  pose_ = in_tissue;
  pose_.orientation.normalize();
  device_frame_ = {frame, place.in_tissue->orientation.conjugate()};
  status_.seen = true;
  ++status_.accepted;
  return std::nullopt;
}

/// Poses of a clock that stands still (ours, where ROS time is simulated) are told from those of a driver that hangs by
/// ROS time: it goes on meanwhile. A device's clock may differ from ours; its delay shows as a change of the
/// difference.
std::optional<Drop> StylusMailbox::checkStamp(const ros::Time& stamp, const Arrival& now) const {
  if (!status_.seen) return std::nullopt;
  if (stamp == stamp_) {
    const bool hangs = now.ros != stamp_came_ && isStale(now.steady);
    return hangs ? std::optional<Drop>(Drop::kRepeatedStamp) : std::nullopt;
  }
  const bool clock_set_anew = stamp < stamp_ || now.steady - received_ > kNewClock;
  const bool late = delay_s(stamp, now) - swiftest_s_ > config_.stale_after_s;
  return late && !clock_set_anew ? std::optional<Drop>(Drop::kDelayed) : std::nullopt;
}

void StylusMailbox::noteStamp(const ros::Time& stamp, const Arrival& now) {
  if (!isLive(now.steady)) {
    endButtons();
    came_ = now.steady;
  }
  const bool repeated = status_.seen && stamp == stamp_;
  if (repeated && now.ros != stamp_came_) return;  // may be a driver that hangs: it grows stale
  const bool new_clock = !status_.seen || stamp < stamp_ || now.steady - received_ > kNewClock;
  swiftest_s_ = new_clock ? delay_s(stamp, now) : std::min(swiftest_s_, delay_s(stamp, now));
  stamp_ = stamp;
  stamp_came_ = now.ros;
  received_ = now.steady;
}

std::optional<Drop> StylusMailbox::put(size_t button, const sensor_msgs::Joy& message, SteadyTime now) {
  if (message.buttons.empty()) return drop(Drop::kNoButtons);
  const int value = message.buttons.front();
  if (value < 0 || value > 2) return drop(Drop::kButtonValue);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!isLive(now)) endButtons();
  Button& state = buttons_.at(button);
  // A driver that tells the state of its buttons again and again tells soon what was down when the hand came.
  const bool was_down = !isLive(now) || (!state.heard && now - came_ < kFirstButtons);
  state.heard = true;
  state.must_release = value == 1 && (state.must_release || was_down);
  const bool ignored = state.must_release || (value == 2 && !isLive(now));
  status_.presses_ignored += value != 0 && ignored;
  state.held = value == 1 && !ignored;  // CRTK: 0 released, 1 pressed, 2 clicked: pressed and let go
  state.pressed_since = state.pressed_since || (value != 0 && !ignored);
  return std::nullopt;
}

bool StylusMailbox::Button::take() {
  const bool pressed = held || pressed_since;
  pressed_since = false;
  return pressed;
}

void StylusMailbox::Button::end() {
  must_release = must_release || held;
  held = pressed_since = heard = false;
}

void StylusMailbox::endButtons() {
  for (Button& button : buttons_) button.end();
}

void StylusMailbox::forgetButtons() {
  const std::lock_guard<std::mutex> lock(mutex_);
  endButtons();
}

bool StylusMailbox::isStale(SteadyTime now) const {
  return std::chrono::duration<double>(now - received_).count() > config_.stale_after_s;
}

StylusSample StylusMailbox::take(SteadyTime now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!isLive(now)) endButtons();
  StylusSample sample;
  sample.valid = isLive(now);
  sample.pose = pose_;
  sample.received = received_;
  sample.button1 = buttons_[0].take();
  sample.button2 = buttons_[1].take();
  return sample;
}

StylusSample StylusMailbox::peek(SteadyTime now) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  StylusSample sample;
  sample.valid = isLive(now);
  sample.pose = pose_;
  sample.received = received_;
  return sample;
}

StylusStatus StylusMailbox::status(SteadyTime now) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  StylusStatus out = status_;
  out.stale = out.seen && isStale(now);
  out.input_age_s = out.seen ? std::chrono::duration<double>(now - received_).count() : 0;
  return out;
}

DeviceFrame StylusMailbox::deviceFrame() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return device_frame_;
}

}  // namespace viscera::nodes
