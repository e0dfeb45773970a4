// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/stylus_mailbox.h"

#include <cmath>

#include "nodes/conversions.h"

namespace viscera::nodes {
namespace {

/// tf2 refuses names with a leading slash, which drivers older than tf2 still send.
std::string tf2Name(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

}  // namespace

const char* text(Drop reason) {
  static constexpr std::array<const char*, kDropReasons> kNames = {
      "stamp_zero", "not_finite", "bad_quaternion", "no_transform", "outside_workspace", "no_buttons", "button_value"};
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
                                       SteadyTime now) {
  if (message.header.stamp.isZero()) return drop(Drop::kStampZero);
  Pose in_device = fromMessage(message.pose);
  if (!isFinite(in_device)) return drop(Drop::kNotFinite);
  // negated, so that an overflow of the norm is refused too
  if (!(std::abs(in_device.orientation.norm() - 1) <= kQuaternionTolerance)) return drop(Drop::kBadQuaternion);
  in_device.orientation.normalize();

  const std::string& named = message.header.frame_id;
  const std::string frame = named.empty() ? tissue_frame_ : tf2Name(named);
  const std::optional<Pose> device_in_tissue = frame == tissue_frame_ ? Pose{} : lookup(frame);
  if (!device_in_tissue) return drop(Drop::kNoTransform);
  const Pose in_tissue = *device_in_tissue * in_device;
  if (!isFinite(in_tissue)) return drop(Drop::kNotFinite);
  if (!(in_tissue.position_m.norm() <= config_.workspace_m)) return drop(Drop::kOutsideWorkspace);

  const std::lock_guard<std::mutex> lock(mutex_);
  pose_ = in_tissue;
  pose_.orientation.normalize();
  device_frame_ = {frame, device_in_tissue->orientation.conjugate()};
  received_ = now;
  status_.seen = true;
  ++status_.accepted;
  return std::nullopt;
}

std::optional<Drop> StylusMailbox::put(size_t button, const sensor_msgs::Joy& message) {
  if (message.buttons.empty()) return drop(Drop::kNoButtons);
  const int value = message.buttons.front();
  if (value < 0 || value > 2) return drop(Drop::kButtonValue);
  const std::lock_guard<std::mutex> lock(mutex_);
  Button& state = buttons_.at(button);
  state.held = value == 1;  // CRTK: 0 released, 1 pressed, 2 clicked: pressed and let go
  state.pressed_since = state.pressed_since || value != 0;
  return std::nullopt;
}

bool StylusMailbox::Button::take() {
  const bool pressed = held || pressed_since;
  pressed_since = false;
  return pressed;
}

bool StylusMailbox::isStale(SteadyTime now) const {
  return std::chrono::duration<double>(now - received_).count() > config_.stale_after_s;
}

StylusSample StylusMailbox::take(SteadyTime now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  StylusSample sample;
  sample.valid = status_.seen && !isStale(now);
  sample.pose = pose_;
  sample.received = received_;
  sample.button1 = buttons_[0].take();
  sample.button2 = buttons_[1].take();
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
