// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/hands.h"

#include "model/scene/tool_kinds.h"

namespace viscera {

namespace {

ToolMode modeOf(const StylusConfig& config, const StylusSample& sample) {
  if (!sample.valid) return ToolMode::kNone;
  if (sample.button2) return config.button2;
  return sample.button1 ? config.button1 : config.idle;
}

}  // namespace

Tools::Tools(const std::vector<StylusConfig>& styluses, double max_travel_m)
    : configs_(styluses), max_travel_m_(max_travel_m) {}

ToolMotions Tools::advance(const StylusSamples& samples) {
  ToolMotions motions;
  for (size_t i = 0; i < configs_.size(); ++i) {
    const StylusSample& now = samples[i];
    StylusMotion& motion = motions[i];
    motion.mode = modeOf(configs_[i], now);
    motion.present = now.valid;
    motion.to = now.valid ? now.pose : last_[i].pose;
    motion.from = last_[i].valid ? last_[i].pose : motion.to;
    if (motion.mode != mode_[i]) {
      motion.hold_begins = kindOf(motion.mode).does(kHolds);
      if (kindOf(mode_[i]).does(kHolds)) motion.hold_ended = mode_[i];
    }
    holdBack(motion);
    last_[i] = now;
    last_[i].pose = motion.to;
    mode_[i] = motion.mode;
  }
  return motions;
}

void Tools::holdBack(StylusMotion& motion) const {
  const Vector3d travel = motion.to.position_m - motion.from.position_m;
  const double length = travel.norm();
  motion.held_back = length > max_travel_m_;
  if (motion.held_back) motion.to.position_m = motion.from.position_m + max_travel_m_ / length * travel;
}

void Tools::reset() {
  last_ = {};
  mode_ = {};
}

}  // namespace viscera
