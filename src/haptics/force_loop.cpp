// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/force_loop.h"

#include <algorithm>
#include <chrono>

namespace viscera {
namespace {

std::vector<ForceLimits> limitsOf(const std::vector<ForceLoop::Stylus>& styluses) {
  std::vector<ForceLimits> out;
  for (const ForceLoop::Stylus& stylus : styluses) out.push_back(stylus.limits);
  return out;
}

HandsThere thereOf(const ForceLoop::Hands& hands) {
  HandsThere there{};
  for (size_t s = 0; s < hands.size(); ++s) there[s] = hands[s].feels();
  return there;
}

}  // namespace

ForceLoop::ForceLoop(const std::vector<Stylus>& styluses, bool between_ticks, double stall_s)
    : between_ticks_(between_ticks && !styluses.empty()),
      schedule_(limitsOf(styluses), stall_s),
      answers_(styluses.size(), 0) {
  if (!between_ticks_) return;
  for (const Stylus& stylus : styluses) servos_.emplace_back(stylus.servo);
  period_ =
      std::chrono::duration_cast<SteadyTime::duration>(std::chrono::duration<double>(styluses.front().servo.period_s));
}

void ForceLoop::put(const Ticks& ticks, const Hands& hands, SteadyTime now) {
  schedule_.tick(now);
  for (size_t s = 0; s < servos_.size(); ++s) {
    if (ticks[s].tracked)
      servos_[s].put(ticks[s].contact, seconds(now));
    else
      servos_[s].clear(seconds(now));
  }
  if (answering_) return;
  Wrenches wanted;
  HandsThere there{};
  for (size_t s = 0; s < ticks.size(); ++s) {
    wanted[s] = ticks[s].reaction;
    there[s] = ticks[s].tracked && hands[s].feels();
  }
  schedule_.want(wanted, there, now);
}

void ForceLoop::rest(SteadyTime now) {
  schedule_.rest(now);
  clear(now);
}

void ForceLoop::release(SteadyTime now) {
  schedule_.release(now);
}

void ForceLoop::suspend(SteadyTime now) {
  schedule_.suspend(now);
}

void ForceLoop::resume(SteadyTime now) {
  schedule_.resume(now);
  clear(now);
}

void ForceLoop::clear(SteadyTime now) {
  for (HapticServo& servo : servos_) servo.clear(seconds(now));
}

SteadyTime ForceLoop::due() const {
  return answering_ ? std::min(period_due_, schedule_.due()) : schedule_.due();
}

/// Starts or stops evaluation, depending on tracked styluses that subscribe. Discards the motion of devices when it
/// stops.
void ForceLoop::updateListeners(const Hands& hands, SteadyTime now) {
  const HandsThere there = thereOf(hands);
  const bool answers = between_ticks_ && schedule_.live() && std::find(there.begin(), there.end(), true) != there.end();
  if (answers == answering_) return;
  answering_ = answers;
  period_due_ = now;
  if (answering_) return;
  for (HapticServo& servo : servos_) servo.leave();
  schedule_.want({}, {}, now);
}

Wrenches ForceLoop::next(const Hands& hands, SteadyTime now) {
  updateListeners(hands, now);
  if (answering_ && now >= period_due_) {
    answer(hands, now);
    period_due_ += (1 + (now - period_due_) / period_) * period_;  // missed periods are skipped
  }
  Wrenches out = schedule_.next(now);
  if (!answering_ || !schedule_.live()) return out;
  for (size_t s = 0; s < servos_.size(); ++s) {
    if (!hands[s].feels()) continue;
    out[s].force_n = servos_[s].damped(out[s].force_n, seconds(now));
    schedule_.lessened(s, out[s].force_n);
  }
  return out;
}

/// Evaluates the local models at the newest poses.
void ForceLoop::answer(const Hands& hands, SteadyTime now) {
  Wrenches wanted;
  for (size_t s = 0; s < servos_.size(); ++s) {
    if (!hands[s].feels()) {
      if (hands[s].tracked)
        servos_[s].leave();
      else
        servos_[s].clear(seconds(now));
      continue;
    }
    wanted[s] = servos_[s].step(hands[s].tip_m, seconds(hands[s].told), seconds(now));
    ++answers_[s];
  }
  schedule_.want(wanted, thereOf(hands), now);
}

void ForceLoop::sent(const std::array<Vector3d, layout::kMaxStyluses>& hand_forces_n, SteadyTime now) {
  if (!answering_) return;
  for (size_t s = 0; s < servos_.size(); ++s) servos_[s].sent(hand_forces_n[s], seconds(now));
}

ForceLoop::HapticStats ForceLoop::felt(size_t stylus) const {
  if (!between_ticks_) return {};
  const HapticServo& servo = servos_[stylus];
  return {servo.passivity().energy_j(), servo.passivity().least_j(), servo.share(), answers_[stylus]};
}

}  // namespace viscera
