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
    holdBack(motion);
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

void Tools::holdBack(StylusMotion& motion) const {
  const Vector3d travel = motion.to.position_m - motion.from.position_m;
  const double length = travel.norm();
  motion.speed_limited = length > limits_.max_travel_m;
  if (motion.speed_limited) motion.to.position_m = motion.from.position_m + limits_.max_travel_m / length * travel;
}

void Tools::feel(size_t stylus, StylusMotion& motion) const {
  const ToolKind& kind = kindOf(motion.mode);
  if (!inside_[stylus] || !kind.does(kPushes)) return;
  motion.feels_m = std::max(limits_.feel_radius_m, kind.reach_m(configs_[stylus]));
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
}

void Tools::reset() {
  last_ = {};
  mode_ = {};
  inside_ = {};
  forgotten_ = {};
  fingers_ = {};
}

}  // namespace viscera
