// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/stylus.h"

#include <algorithm>

namespace viscera {

namespace {

layout::vec4 pack(const Vector3d& v, double w) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), static_cast<float>(w)};
}

ToolMode modeOf(const StylusConfig& config, const StylusSample& sample) {
  if (!sample.valid) return ToolMode::kNone;
  if (sample.button2) return config.button2;
  return sample.button1 ? config.button1 : config.idle;
}

layout::ToolMotion substep(const StylusMotion& motion, const StylusConfig& config, double begin, double end) {
  const Pose from = interpolate(motion.from, motion.to, begin);
  const Pose to = interpolate(motion.from, motion.to, end);
  const Vector3d blade_tip(0, 0, -config.blade_length_m);
  const double radius = motion.mode == ToolMode::kGrab ? config.grab_radius_m : config.probe_radius_m;
  layout::ToolMotion out;
  out.from = pack(from.position_m, radius);
  out.to = pack(to.position_m, config.release_speed_m_per_s);
  out.orientation = pack(to.orientation.vec(), to.orientation.w());
  out.blade_from = pack(from * blade_tip, config.eraser_radius_m);
  out.blade_to = pack(to * blade_tip, 0);
  out.info = {static_cast<uint32_t>(motion.mode), 0, 0, 0};
  return out;
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
    motion.grab_begins = motion.mode == ToolMode::kGrab && mode_[i] != ToolMode::kGrab;
    motion.grab_ends = motion.mode != ToolMode::kGrab && mode_[i] == ToolMode::kGrab;
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

void interpolateMotions(const ToolMotions& motions, const std::vector<StylusConfig>& configs, int substeps,
                        std::vector<layout::ToolMotion>& out) {
  out.assign(static_cast<size_t>(substeps) * layout::kMaxStyluses, layout::ToolMotion{});
  for (size_t i = 0; i < configs.size(); ++i) {
    if (motions[i].mode == ToolMode::kNone) continue;
    for (int s = 0; s < substeps; ++s) {
      out[static_cast<size_t>(s) * layout::kMaxStyluses + i] =
          substep(motions[i], configs[i], static_cast<double>(s) / substeps, static_cast<double>(s + 1) / substeps);
    }
  }
}

ForceLimiter::ForceLimiter(double max_force_n, double max_rate_n_per_s)
    : max_force_n_(max_force_n), max_rate_n_per_s_(max_rate_n_per_s) {}

Reaction ForceLimiter::limit(const Reaction& raw, double tick_s) {
  Reaction out = raw;
  if (!raw.force_n.allFinite() || !raw.torque_nm.allFinite()) {  // the tissue is lost: no force, at once
    out = Reaction{};
    out.saturated = true;
    last_ = out;
    return out;
  }
  const double size = raw.force_n.norm();
  if (size > max_force_n_) {
    out.force_n *= max_force_n_ / size;
    out.torque_nm *= max_force_n_ / size;
    out.saturated = true;
  }
  const Vector3d change = out.force_n - last_.force_n;
  const double allowed = max_rate_n_per_s_ * tick_s;
  if (change.norm() > allowed) {
    const double share = allowed / change.norm();
    out.force_n = last_.force_n + share * change;
    out.torque_nm = last_.torque_nm + share * (out.torque_nm - last_.torque_nm);
    out.saturated = true;
  }
  last_ = out;
  return out;
}

}  // namespace viscera
