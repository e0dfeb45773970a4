// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/wrench_schedule.h"

#include <algorithm>
#include <chrono>

namespace viscera {
namespace {

/// Limits the jump of a wrench that was constant for long: its slew rate applies to at most this time [s].
constexpr double kLongestSlew_s = 2 * WrenchSchedule::kSlewPeriod_s;

double seconds(WrenchSchedule::Time::duration span) {
  return std::chrono::duration<double>(span).count();
}

bool same(const Reaction& a, const Reaction& b) {
  return a.force_n == b.force_n && a.torque_nm == b.torque_nm;
}

}  // namespace

WrenchSchedule::WrenchSchedule(const std::vector<ForceLimits>& limits, double stall_s)
    : letting_go_(limits.size()), stall_s_(stall_s) {
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
  return seconds(now - last_tick_) > stall_s_;
}

void WrenchSchedule::tick(Time now) {
  if (closed()) return;
  noticeStall(now);
  if (mode_ == Mode::kResting) mode_ = Mode::kLive;
  if (mode_ == Mode::kStalled) {
    in_time_ = late(now) ? 0 : in_time_ + 1;
    if (in_time_ >= kTicksInTime) mode_ = Mode::kLive;
  }
  last_tick_ = now;
}

void WrenchSchedule::request(const Wrenches& wanted, const ListeningStyluses& there, Time now) {
  if (mode_ != Mode::kLive) return;
  for (size_t s = 0; s < limiters_.size(); ++s) {
    wanted_[s] = there[s] ? wanted[s] : Reaction{};
    if (there[s])
      letting_go_[s].on = false;
    else
      letGo(s, kLetGo_s, now);
  }
  reached_ = false;
}

void WrenchSchedule::rest(Time now) {
  if (closed()) return;
  mode_ = Mode::kResting;
  last_tick_ = now;
  letAllGo(kLetGo_s, now);
}

void WrenchSchedule::release(Time now) {
  if (mode_ != Mode::kReleased) close(Mode::kReleased, now);
}

void WrenchSchedule::suspend(Time now) {
  if (!closed()) close(Mode::kSuspended, now);
}

void WrenchSchedule::resume(Time now) {
  if (mode_ != Mode::kSuspended) return;
  mode_ = Mode::kResting;
  rest(now);
}

void WrenchSchedule::close(Mode mode, Time now) {
  mode_ = mode;
  silent_ = false;
  letAllGo(kRelease_s, now);
}

void WrenchSchedule::noticeStall(Time now) {
  if (mode_ != Mode::kLive || !late(now)) return;
  mode_ = Mode::kStalled;
  in_time_ = 0;
  ++stalls_;
  letAllGo(kRelease_s, now);
}

void WrenchSchedule::letGo(size_t stylus, double within_s, Time now) {
  LettingGo& it = letting_go_[stylus];
  if (it.on && it.within_s <= within_s) return;
  const Reaction& last = limiters_[stylus].last();
  it = {true, now, within_s, last.force_n.norm(), last.torque_nm.norm()};
}

void WrenchSchedule::letAllGo(double within_s, Time now) {
  wanted_ = {};
  reached_ = false;
  for (size_t s = 0; s < limiters_.size(); ++s) letGo(s, within_s, now);
}

WrenchSchedule::Time WrenchSchedule::due() const {
  if (!reached_) return after(last_next_, kSlewPeriod_s);
  if (mode_ == Mode::kLive) return after(last_tick_, stall_s_);
  return after(last_next_, kIdlePeriod_s);
}

/// Returns the limits for a stall or an end: the largest allowed wrench fades out within kRelease_s, a smaller one
/// sooner.
ForceLimits WrenchSchedule::limitsNow(const ForceLimits& usual) const {
  ForceLimits limits = usual;
  if (mode_ != Mode::kStalled && !closed()) return limits;
  limits.force_rate_n_per_s = std::max(usual.force_rate_n_per_s, usual.force_n / kRelease_s);
  limits.torque_rate_nm_per_s = std::max(usual.torque_rate_nm_per_s, usual.torque_nm / kRelease_s);
  return limits;
}

Reaction WrenchSchedule::next(size_t stylus, double span_s, Time now) {
  ForceLimiter& limiter = limiters_[stylus];
  const LettingGo& going = letting_go_[stylus];
  const Reaction out = limiter.limit(wanted_[stylus], span_s, limitsNow(limiter.limits()));
  if (!going.on) return out;
  const double left = std::max(1 - seconds(now - going.since) / going.within_s, 0.0);
  return limiter.shrink(left * going.force_n, left * going.torque_nm);
}

Wrenches WrenchSchedule::next(Time now) {
  noticeStall(now);
  const double span_s = std::min(seconds(now - last_next_), kLongestSlew_s);
  last_next_ = now;
  reached_ = silent_ = true;
  Wrenches out;
  for (size_t s = 0; s < limiters_.size(); ++s) {
    const Reaction before = limiters_[s].last();
    out[s] = next(s, span_s, now);
    const bool silent = same(out[s], Reaction{});
    reached_ = reached_ && (letting_go_[s].on ? silent : !out[s].saturated || same(out[s], before));
    silent_ = silent_ && silent;
  }
  return out;
}

}  // namespace viscera
