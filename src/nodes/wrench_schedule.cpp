// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/wrench_schedule.h"

#include <algorithm>
#include <chrono>

namespace viscera::nodes {
namespace {

/// A wrench that was held for long does not leap all the way that its slew would have allowed meanwhile.
constexpr double kLongestSlew_s = 2 * WrenchSchedule::kSlewPeriod_s;

double seconds(WrenchSchedule::Time::duration span) {
  return std::chrono::duration<double>(span).count();
}

bool same(const Reaction& a, const Reaction& b) {
  return a.force_n == b.force_n && a.torque_nm == b.torque_nm;
}

}  // namespace

WrenchSchedule::WrenchSchedule(const std::vector<ForceLimits>& limits, double stall_s) : stall_s_(stall_s) {
  for (const ForceLimits& of_one : limits) limiters_.emplace_back(of_one);
}

WrenchSchedule::Time WrenchSchedule::after(Time time, double span_s) {
  return time + std::chrono::duration_cast<Time::duration>(std::chrono::duration<double>(span_s));
}

void WrenchSchedule::setLimits(size_t stylus, const ForceLimits& limits) {
  limiters_[stylus].setLimits(limits);
  reached_ = false;
}

bool WrenchSchedule::late(Time now) const {
  return seconds(now - last_put_) > stall_s_;
}

void WrenchSchedule::put(const Wrenches& wanted, Time now) {
  if (mode_ == Mode::kReleased) return;
  noticeStall(now);
  if (mode_ == Mode::kResting) mode_ = Mode::kLive;
  if (mode_ == Mode::kStalled) {
    in_time_ = late(now) ? 0 : in_time_ + 1;
    if (in_time_ >= kTicksInTime) mode_ = Mode::kLive;
  }
  last_put_ = now;
  wanted_ = mode_ == Mode::kLive ? wanted : Wrenches{};
  reached_ = false;
}

void WrenchSchedule::follow(const Wrenches& wanted) {
  if (mode_ != Mode::kLive) return;
  wanted_ = wanted;
  reached_ = false;
}

void WrenchSchedule::rest(Time now) {
  if (mode_ == Mode::kReleased) return;
  mode_ = Mode::kResting;
  last_put_ = now;
  wanted_ = {};
  reached_ = false;
}

void WrenchSchedule::release(Time) {
  if (mode_ == Mode::kReleased) return;
  mode_ = Mode::kReleased;
  wanted_ = {};
  reached_ = silent_ = false;
}

void WrenchSchedule::noticeStall(Time now) {
  if (mode_ != Mode::kLive || !late(now)) return;
  mode_ = Mode::kStalled;
  in_time_ = 0;
  ++stalls_;
  wanted_ = {};
  reached_ = false;
}

WrenchSchedule::Time WrenchSchedule::due() const {
  if (!reached_) return after(last_next_, kSlewPeriod_s);
  if (mode_ == Mode::kLive) return after(last_put_, stall_s_);
  return after(last_next_, kIdlePeriod_s);
}

/// In an end or a stall the slew is what it takes to be at zero within kRelease_s, or the usual one where that is
/// faster.
ForceLimits WrenchSchedule::limitsNow(const ForceLimits& usual) const {
  ForceLimits limits = usual;
  if (mode_ != Mode::kStalled && mode_ != Mode::kReleased) return limits;
  limits.force_rate_n_per_s = std::max(usual.force_rate_n_per_s, usual.force_n / kRelease_s);
  limits.torque_rate_nm_per_s = std::max(usual.torque_rate_nm_per_s, usual.torque_nm / kRelease_s);
  return limits;
}

Wrenches WrenchSchedule::next(Time now) {
  noticeStall(now);
  const double span_s = std::min(seconds(now - last_next_), kLongestSlew_s);
  last_next_ = now;
  reached_ = silent_ = true;
  Wrenches out;
  for (size_t s = 0; s < limiters_.size(); ++s) {
    ForceLimiter& limiter = limiters_[s];
    const Reaction before = limiter.last();
    out[s] = limiter.limit(wanted_[s], span_s, limitsNow(limiter.limits()));
    reached_ = reached_ && (!out[s].saturated || same(out[s], before));
    silent_ = silent_ && same(out[s], Reaction{});
  }
  return out;
}

}  // namespace viscera::nodes
