// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/stability_monitor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "viscera/solver/material.h"

namespace viscera {

namespace {

constexpr double kSpeedMargin = 5;       // over the fastest speed that physics allows: tools may throw nodes faster
constexpr double kLongestRecovery = 16;  // in recovery_s, while trips keep coming
constexpr double kSoon = 4;  // in recovery_s: a trip this soon after a recovery doubles the length of the next one

float fromBits(uint32_t bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace

StabilityMonitor::Limits stabilityLimits(const Model& model, double gravity_m_per_s2, double sleep_distance_m) {
  double mass = 0;
  for (const Body& body : model.bodies) mass += massOf_kg(body);
  const double wave = waveSpeed(model), fall2 = 2 * gravity_m_per_s2 * sleep_distance_m;
  return {kSpeedMargin * std::max(wave, std::sqrt(fall2)), mass * (wave * wave + fall2)};
}

StabilityMonitor::StabilityMonitor(const Limits& limits, double tick_s, double recovery_s)
    : limits_(limits), tick_s_(tick_s), recovery_s_(recovery_s), recovery_wanted_s_(recovery_s) {}

void StabilityMonitor::restart(const layout::TickStats& stats) {
  owned_j_ = static_cast<double>(stats.kinetic_j) + stats.elastic_j;
  record(stats);
  setbacks_ = 0;
  short_ticks_left_ = 0;
  short_wanted_s_ = 0;
  recovery_ticks_left_ = 0;
  recovery_wanted_s_ = recovery_s_;
  ticks_since_recovery_ = 0;
  health_.recovering = false;
}

StabilityMonitor::Bounds StabilityMonitor::bounds(bool implicit) const {
  return {implicit ? std::numeric_limits<double>::infinity() : limits_.speed_m_per_s,
          kEnergyMargin * (owned_j_ + limits_.energy_j)};
}

StabilityMonitor::Trip StabilityMonitor::inspect(const layout::TickStats& stats, bool implicit, double work_j) const {
  const double energy = static_cast<double>(stats.kinetic_j) + stats.elastic_j;
  if (stats.nonfinite > 0 || !std::isfinite(energy)) return Trip::kNonFinite;
  const Bounds most = bounds(implicit);
  if (energy > most.energy_j + kEnergyMargin * work_j) return Trip::kEnergy;
  if (fromBits(stats.max_speed_bits) > most.speed_m_per_s) return Trip::kSpeed;
  return Trip::kNone;
}

StabilityMonitor::Trip StabilityMonitor::judge(const layout::TickStats& stats, bool implicit, double work_j,
                                               bool long_substeps) {
  const Trip trip = inspect(stats, implicit, work_j);
  if (trip != Trip::kNone) {
    if (long_substeps)
      shorten();
    else
      recover();
    return trip;
  }
  short_ticks_left_ = std::max<int64_t>(0, short_ticks_left_ - 1);
  ++ticks_since_short_;
  setbacks_ = 0;
  owned_j_ = std::min(owned_j_ + work_j, static_cast<double>(stats.kinetic_j) + stats.elastic_j);
  record(stats);
  const bool calm = fromBits(stats.max_speed_bits) < 0.5 * limits_.speed_m_per_s;
  if (health_.recovering && --recovery_ticks_left_ <= 0 && calm) {
    health_.recovering = false;
    ticks_since_recovery_ = 0;
  } else {
    ++ticks_since_recovery_;
  }
  return trip;
}

/// Records the measurements of a good state.
void StabilityMonitor::record(const layout::TickStats& stats) {
  health_.kinetic_j = stats.kinetic_j;
  health_.elastic_j = stats.elastic_j;
  const bool is_long = fromBits(stats.max_stretch_bits) > kStrainedStretch;
  const bool odd = short_ticks_left_ > 0 || stats.collapsed > 0 || stats.inverted > 0 ||
                   fromBits(stats.max_speed_bits) > limits_.speed_m_per_s / kSpeedMargin;
  health_.strained = is_long || odd;
  // The force at which pressed nodes slip off a tool depends on the substep (docs/verification.md).
  const bool handled = stats.touched[0] + stats.touched[1] + stats.grabbed[0] + stats.grabbed[1] > 0;
  health_.only_long = is_long && !odd && !handled;
}

/// Continues from the last good state with the shorter substep; for longer if that happened recently.
void StabilityMonitor::shorten() {
  const bool soon = short_wanted_s_ > 0 && static_cast<double>(ticks_since_short_) * tick_s_ < kSoon * short_wanted_s_;
  short_wanted_s_ = soon ? std::min(2 * short_wanted_s_, kLongestRecovery * recovery_s_) : recovery_s_;
  short_ticks_left_ = std::max<int64_t>(1, std::llround(short_wanted_s_ / tick_s_));
  ticks_since_short_ = 0;
  health_.strained = true;
  health_.only_long = false;
  ++health_.trips;
  ++setbacks_;
}

void StabilityMonitor::recover() {
  const bool soon = health_.trips > 0 && static_cast<double>(ticks_since_recovery_) * tick_s_ < kSoon * recovery_s_;
  recovery_wanted_s_ = soon && !health_.recovering ? std::min(2 * recovery_wanted_s_, kLongestRecovery * recovery_s_)
                       : soon                      ? recovery_wanted_s_
                                                   : recovery_s_;
  recovery_ticks_left_ = std::max<int64_t>(1, std::llround(recovery_wanted_s_ / tick_s_));
  health_.recovering = true;
  health_.strained = true;
  health_.only_long = false;
  ++health_.trips;
  ++setbacks_;
}

}  // namespace viscera
