// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/tools.h"

#include <algorithm>

#include "math/archive.h"
#include "model/scene/tool_kinds.h"
#include "tools/restored_tools.h"
#include "viscera/tools/trocar.h"

namespace viscera {

namespace {

constexpr double kShaftGrows_m_per_s = 0.1;  ///< speed of a hand that draws back a blade

ToolSwitch switchOf(const StylusSample& sample) {
  if (sample.button2) return ToolSwitch::kButton2;
  return sample.button1 ? ToolSwitch::kButton1 : ToolSwitch::kIdle;
}

template <class Config>
auto& modeAt(Config& config, ToolSwitch when) {
  if (when == ToolSwitch::kIdle) return config.idle;
  return when == ToolSwitch::kButton1 ? config.button1 : config.button2;
}

ToolMode modeOf(const StylusConfig& config, const StylusSample& sample) {
  return sample.valid ? modeAt(config, switchOf(sample)) : ToolMode::kNone;
}

}  // namespace

Tools::Tools(const std::vector<StylusConfig>& styluses, const ToolLimits& limits)
    : configs_(styluses), limits_(limits) {}

ToolMotions Tools::advance(const StylusSamples& samples, const FeelTissue& between) {
  ToolMotions motions;
  for (size_t i = 0; i < configs_.size(); ++i) {
    const StylusSample& now = samples[i];
    StylusMotion& motion = motions[i];
    motion.mode = modeOf(configs_[i], now);
    motion.present = now.valid;
    const Trocar trocar(configs_[i]);
    motion.to = now.valid ? trocar.toolPose(now.pose) : last_[i].pose;
    motion.from = last_[i].valid ? last_[i].pose : motion.to;
    if (!last_[i].valid) inside_[i] = limits_.feel_radius_m > 0;
    changeMode(i, motion);
    moveShaft(i, motion);
    holdBack(configs_[i], motion);
    if (motion.speed_limited) motion.to = trocar.throughPoint(motion.to);
    close(i, now.jaw_rad, between, motion);
    feel(i, motion);
    last_[i] = now;
    last_[i].pose = motion.to;
  }
  return motions;
}

void Tools::changeMode(size_t stylus, StylusMotion& motion) {
  if (motion.mode != mode_[stylus] || forgotten_[stylus]) {
    motion.hold_begins = kindOf(motion.mode).does(kHolds);
    if (kindOf(mode_[stylus]).does(kHolds)) motion.hold_ended = mode_[stylus];
    fingers_[stylus] = {};
  }
  mode_[stylus] = motion.mode;
  forgotten_[stylus] = false;
}

/// Closes jaws. They are open until the mode begins. @param angle_rad  StylusSample::jaw_rad
void Tools::close(size_t stylus, float angle_rad, const FeelTissue& between, StylusMotion& motion) {
  const ToolKind& kind = kindOf(motion.mode);
  if (!kind.jaws) return;
  const auto here = [&](double mouth_rad) { return between(stylus, motion, mouth_rad); };
  fingers_[stylus].advance(kind.jaws(configs_[stylus]), kind.grips, angle_rad, !last_[stylus].valid, limits_.tick_s,
                           between ? here : std::function<std::optional<Between>(double)>(), motion);
}

ToolMotions Tools::ofHeld(const ToolMotions& motions) const {
  ToolMotions out = motions;
  for (size_t i = 0; i < configs_.size(); ++i)
    if (fingers_[i].holds()) out[i] = fingers_[i].ofHeld(motions[i]);
  return out;
}

bool Tools::grips(const ToolMotions& motions) const {
  return std::any_of(motions.begin(), motions.end(),
                     [](const StylusMotion& motion) { return kindOf(motion.mode).grips; }) &&
         std::any_of(fingers_.begin(), fingers_.end(), [](const Gripper& fingers) { return fingers.holds(); });
}

void Tools::pulled(size_t stylus, const StylusMotion& motion, const Vector3d& force_n) {
  const ToolKind& kind = kindOf(motion.mode);
  if (kind.grips) fingers_[stylus].pulled(motion, force_n, kind.grip(configs_[stylus]).max_force_n);
}

/// Moves the near end of a shaft that tissue meets to where that of the mode is: back at once, forward slowly, so that
/// it does not appear in the tissue around a blade or a jaw.
void Tools::moveShaft(size_t stylus, StylusMotion& motion) {
  const StylusConfig& config = configs_[stylus];
  if (!config.shaft_contact || !motion.present) return;
  const double goal_m = shaftBegin(config, kindOf(motion.mode));
  double& now_m = shaft_m_[stylus];
  motion.shaft_from_m = last_[stylus].valid ? std::max(now_m, goal_m) : goal_m;
  motion.shaft_to_m = now_m = std::max(goal_m, motion.shaft_from_m - kShaftGrows_m_per_s * limits_.tick_s);
}

/// Limits the speed of a tip, and of the far end of a shaft that tissue meets.
void Tools::holdBack(const StylusConfig& config, StylusMotion& motion) const {
  const Vector3d travel = motion.to.position_m - motion.from.position_m;
  const double length = travel.norm();
  motion.speed_limited = length > limits_.max_travel_m;
  if (motion.speed_limited) motion.to.position_m = motion.from.position_m + limits_.max_travel_m / length * travel;
  if (motion.shaft_to_m < 0) return;
  const Vector3d end(0, 0, config.shaft_length_m);
  const double swing_m = (motion.to * end - motion.from * end).norm();
  if (swing_m <= limits_.max_travel_m) return;
  motion.speed_limited = true;
  motion.to = interpolate(motion.from, motion.to, limits_.max_travel_m / swing_m);
}

void Tools::feel(size_t stylus, StylusMotion& motion) const {
  const ToolKind& kind = kindOf(motion.mode);
  const bool shaft = motion.shaft_to_m >= 0;
  if (!inside_[stylus] || !(shaft || kind.does(kPushes))) return;
  motion.feels_m = std::max({limits_.feel_radius_m, kind.does(kPushes) ? kind.reach_m(configs_[stylus]) : 0,
                             shaft ? shaftRadius(configs_[stylus]) : 0});
}

void Tools::setMode(size_t stylus, ToolSwitch when, ToolMode mode) {
  ToolMode& now = modeAt(configs_[stylus], when);
  const bool begins = when == switchOf(last_[stylus]) && !kindOf(now).does(kPushes) && kindOf(mode).does(kPushes);
  if (begins) inside_[stylus] = limits_.feel_radius_m > 0;
  now = mode;
}

void Tools::clear() {
  last_ = {};
  forgotten_.fill(true);
}

void Tools::persist(Archive& archive) {
  for (StylusConfig& config : configs_) {
    for (ToolMode* mode : {&config.idle, &config.button1, &config.button2}) {
      ToolMode read = *mode;
      archive.value(read);
      requireMode(archive, read);
      *mode = read;
    }
  }
  archive.value(last_);
  archive.value(mode_);
  archive.value(inside_);
  archive.value(forgotten_);
  for (const ToolMode mode : mode_) requireMode(archive, mode);
  for (Gripper& fingers : fingers_) fingers.persist(archive);
  for (size_t i = 0; i < configs_.size(); ++i)
    if (configs_[i].shaft_contact) archive.value(shaft_m_[i]);
}

void Tools::reset() {
  last_ = {};
  mode_ = {};
  inside_ = {};
  forgotten_ = {};
  fingers_ = {};
  shaft_m_ = {};
}

}  // namespace viscera
