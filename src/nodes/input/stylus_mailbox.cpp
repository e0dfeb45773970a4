// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/stylus_mailbox.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "nodes/ros/conversions.h"

namespace viscera::nodes {
namespace {

/// A driver that repeats its Joy messages sends one within this time of its first pose.
constexpr std::chrono::milliseconds kFirstButtons{250};
/// Largest motion of a tip between two poses that a moving base can cause; more is a relocated base.
constexpr double kBaseLeap_m = 0.005;
/// Largest rotation likewise: the far end of a blade of 5 cm then moves by kBaseLeap_m.
constexpr double kBaseTurn_rad = 0.1;
/// Largest relative drift of two clocks: kernels correct their rate by no more. The delay of a slow driver's queue
/// grows faster.
constexpr double kClockDrift = 500e-6;
/// Silence after which a device may return with a different clock.
constexpr std::chrono::seconds kNewClock{5};

/// Returns the time from stamp to arrival. ros::Duration would throw for a difference of 68 years.
double delay_s(const ros::Time& stamp, const Arrival& now) {
  return now.ros.toSec() - stamp.toSec();
}

}  // namespace

const char* text(Drop reason) {
  static constexpr std::array<const char*, kDropReasons> kNames = {
      "stamp_zero", "not_finite",        "bad_quaternion", "no_transform", "old_transform", "repeated_stamp",
      "delayed",    "outside_workspace", "no_buttons",     "button_value", "jaw_angle",     "joint_count"};
  return kNames[static_cast<size_t>(reason)];
}

StylusMailbox::StylusMailbox(const StylusConfig& config, const std::string& tissue_frame, const DeviceProfile& device)
    : config_(config), tissue_frame_(tissue_frame), device_(device), map_(device) {
  device_frame_.name = tissue_frame;
}

std::optional<Drop> StylusMailbox::drop(Drop reason) {
  const std::lock_guard<PriorityMutex> lock(mutex_);
  ++status_.dropped[static_cast<size_t>(reason)];
  return reason;
}

std::optional<Drop> StylusMailbox::put(const DevicePose& said, const FrameLookup& lookup, const Arrival& now) {
  if (said.stamp.isZero()) return drop(Drop::kStampZero);
  Pose in_device = said.pose;
  if (!isFinite(in_device)) return drop(Drop::kNotFinite);
  if (!isUnit(in_device.orientation)) return drop(Drop::kBadQuaternion);
  in_device.orientation.normalize();

  const std::string& named = device_.pose.frame.empty() ? said.frame : device_.pose.frame;
  const std::string frame = named.empty() ? tissue_frame_ : tf2Name(named);
  const FramePose frame_pose = map_.base()              ? FramePose{*map_.base()}
                               : frame == tissue_frame_ ? FramePose{Pose{}}
                                                        : lookup(frame);
  if (!frame_pose.in_tissue) return drop(frame_pose.too_old ? Drop::kOldTransform : Drop::kNoTransform);

  const std::lock_guard<PriorityMutex> lock(mutex_);
  const auto refuse = [this](Drop reason) {
    ++status_.dropped[static_cast<size_t>(reason)];
    return reason;
  };
  const DeviceMap::TipPose in_base = map_.tipOf(in_device);
  const Pose in_tissue = *frame_pose.in_tissue * in_base.tip;
  if (!isFinite(in_tissue)) return refuse(Drop::kNotFinite);
  if (!(in_tissue.position_m.norm() <= config_.workspace_m)) return refuse(Drop::kOutsideWorkspace);
  if (const std::optional<Drop> late = checkStamp(said.stamp, now)) return refuse(*late);
  recordPosition(frame, *frame_pose.in_tissue, in_base.tip);
  map_.accept(in_base);
  recordStamp(said.stamp, now);
  pose_ = in_tissue;
  pose_.orientation.normalize();
  const Quaterniond axes = map_.axesFromBase();
  device_frame_.name = frame;
  device_frame_.from_tissue = axes * frame_pose.in_tissue->orientation.conjugate();
  device_frame_.lever_arm_m = axes * map_.leverArm(in_device);
  device_frame_.position = in_device.position_m;
  status_.seen = true;
  ++status_.accepted;
  return std::nullopt;
}

/// Records the pose. If the table was moved or turned, the tool did not sweep through the tissue.
/// @param tip  tip in the frame of the base
void StylusMailbox::recordPosition(const std::string& frame, const Pose& base, const Pose& tip) {
  const bool known = status_.seen && frame == device_frame_.name;
  const bool leapt = known && ((base * tip.position_m - base_ * tip.position_m).norm() > kBaseLeap_m ||
                               base.orientation.angularDistance(base_.orientation) > kBaseTurn_rad);
  base_ = base;
  if (!leapt) return;
  endButtons();
  anew_ = Anew::kToTell;
  ++status_.base_moves;
}

/// Checks a stamp. A repeated stamp comes from a stopped clock (ours, if ROS time is simulated) or from a driver that
/// hangs; only in the second case does ROS time advance. The clock of a device may differ from ours, so only changes of
/// the difference count as delay.
std::optional<Drop> StylusMailbox::checkStamp(const ros::Time& stamp, const Arrival& now) const {
  if (!status_.seen) return std::nullopt;
  if (stamp == stamp_) {
    const bool hangs = now.ros != stamp_came_ && isStale(now.steady);
    return hangs ? std::optional<Drop>(Drop::kRepeatedStamp) : std::nullopt;
  }
  const bool clock_set_anew = stamp < stamp_ || now.steady - received_ > kNewClock;
  const bool late = delay_s(stamp, now) - swiftest_s(now.steady) > config_.stale_after_s;
  return late && !clock_set_anew ? std::optional<Drop>(Drop::kDelayed) : std::nullopt;
}

/// Returns the smallest delay. It grows slowly, since a device with a slow clock makes all delays grow.
double StylusMailbox::swiftest_s(SteadyTime now) const {
  return swiftest_s_ + kClockDrift * std::chrono::duration<double>(now - swiftest_came_).count();
}

void StylusMailbox::recordStamp(const ros::Time& stamp, const Arrival& now) {
  if (!isLive(now.steady)) {
    endButtons();
    came_ = now.steady;
  }
  const bool repeated = status_.seen && stamp == stamp_;
  if (repeated && now.ros != stamp_came_) return;  // the driver may hang: the pose becomes stale
  const bool new_clock = !status_.seen || stamp < stamp_ || now.steady - received_ > kNewClock;
  if (new_clock || delay_s(stamp, now) <= swiftest_s(now.steady)) {
    swiftest_s_ = delay_s(stamp, now);
    swiftest_came_ = now.steady;
  }
  stamp_ = stamp;
  stamp_came_ = now.ros;
  received_ = now.steady;
}

std::optional<Drop> StylusMailbox::press(ButtonRole role, const std::vector<int32_t>& values, size_t index,
                                         SteadyTime now) {
  if (index >= values.size()) return drop(Drop::kNoButtons);
  const int value = values[index];
  if (value < 0 || value > 2) return drop(Drop::kButtonValue);
  const std::lock_guard<PriorityMutex> lock(mutex_);
  if (role == ButtonRole::kClutch) {
    map_.setClutch(value == 1);
    return std::nullopt;
  }
  if (!isLive(now)) endButtons();
  Button& state = buttons_[role == ButtonRole::kButton2];
  // Soon after tracking begins, a driver that repeats its button states reports which were down before.
  const bool was_down = !isLive(now) || (!state.heard && now - came_ < kFirstButtons);
  state.heard = true;
  state.must_release = value == 1 && (state.must_release || was_down);
  const bool ignored = state.must_release || (value == 2 && !isLive(now));
  status_.button_presses_ignored += value != 0 && ignored;
  state.held = value == 1 && !ignored;  // CRTK: 0 released, 1 pressed, 2 clicked (pressed and released)
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

void StylusMailbox::clearButtons() {
  const std::lock_guard<PriorityMutex> lock(mutex_);
  endButtons();
}

std::optional<Drop> StylusMailbox::grip(const std::vector<double>& positions, size_t index, SteadyTime now) {
  if (index >= positions.size()) return drop(Drop::kNoButtons);
  if (!std::isfinite(positions[index])) return drop(Drop::kNotFinite);
  const GripperPort& port = device_.gripper;
  if (port.presses == PressedButton::kNone) return std::nullopt;
  const double angle_rad = port.rad_per_unit * positions[index];
  if (std::abs(angle_rad) > kWidestJaw_rad) return drop(Drop::kJawAngle);
  {
    const std::lock_guard<PriorityMutex> lock(mutex_);
    jaw_rad_ = static_cast<float>(std::max(0.0, angle_rad));
  }
  gripped_ = positions[index] < (gripped_ ? port.open_above : port.closed_below);
  if (port.presses == PressedButton::kJaws) return std::nullopt;
  const ButtonRole role = port.presses == PressedButton::kButton1 ? ButtonRole::kButton1 : ButtonRole::kButton2;
  return press(role, {gripped_ ? 1 : 0}, 0, now);
}

void StylusMailbox::hold(bool held) {
  const std::lock_guard<PriorityMutex> lock(mutex_);
  if (held_ && !held) received_ = {};
  held_ = held;
}

bool StylusMailbox::isStale(SteadyTime now) const {
  return !held_ && std::chrono::duration<double>(now - received_).count() > config_.stale_after_s;
}

StylusSample StylusMailbox::take(SteadyTime now) {
  const std::lock_guard<PriorityMutex> lock(mutex_);
  if (!isLive(now)) endButtons();
  StylusSample sample;
  sample.valid = isLive(now) && anew_ != Anew::kToTell;
  if (isLive(now)) anew_ = anew_ == Anew::kToTell ? Anew::kLatencies : Anew::kNo;
  sample.pose = pose_;
  sample.received = received_;
  sample.button1 = buttons_[0].take();
  sample.button2 = buttons_[1].take();
  sample.jaw_rad = jaw_rad_;
  return sample;
}

StylusSample StylusMailbox::peek(SteadyTime now) const {
  const std::lock_guard<PriorityMutex> lock(mutex_);
  StylusSample sample;
  sample.valid = isLive(now) && anew_ == Anew::kNo;
  sample.pose = pose_;
  sample.received = received_;
  return sample;
}

StylusStatus StylusMailbox::status(SteadyTime now) const {
  const std::lock_guard<PriorityMutex> lock(mutex_);
  StylusStatus out = status_;
  out.stale = out.seen && isStale(now);
  out.clutched = map_.clutched();
  out.input_age_s = out.seen ? std::chrono::duration<double>(now - received_).count() : 0;
  return out;
}

Pose StylusMailbox::inDevice(const Pose& in_tissue) const {
  const std::lock_guard<PriorityMutex> lock(mutex_);
  return map_.fromBase(base_.inverse() * in_tissue);
}

bool StylusMailbox::clutched() const {
  const std::lock_guard<PriorityMutex> lock(mutex_);
  return map_.clutched();
}

uint64_t StylusMailbox::baseMoves() const {
  const std::lock_guard<PriorityMutex> lock(mutex_);
  return status_.base_moves;
}

uint64_t StylusMailbox::buttonPressesIgnored() const {
  const std::lock_guard<PriorityMutex> lock(mutex_);
  return status_.button_presses_ignored;
}

DeviceFrame StylusMailbox::deviceFrame() const {
  const std::lock_guard<PriorityMutex> lock(mutex_);
  return device_frame_;
}

}  // namespace viscera::nodes
