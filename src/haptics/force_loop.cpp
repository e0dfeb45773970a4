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

ListeningStyluses thereOf(const ForceLoop::Inputs& inputs) {
  ListeningStyluses there{};
  for (size_t s = 0; s < inputs.size(); ++s) there[s] = inputs[s].isActive();
  return there;
}

}  // namespace

ForceLoop::ForceLoop(const std::vector<Stylus>& styluses, bool between_ticks, double stall_s)
    : between_ticks_(between_ticks && !styluses.empty()),
      schedule_(limitsOf(styluses), stall_s),
      updates_(styluses.size(), 0) {
  if (!between_ticks_) return;
  for (const Stylus& stylus : styluses) servos_.emplace_back(stylus.servo);
  period_ =
      std::chrono::duration_cast<SteadyTime::duration>(std::chrono::duration<double>(styluses.front().servo.period_s));
}

void ForceLoop::put(const Ticks& ticks, const Inputs& inputs, SteadyTime now) {
  schedule_.tick(now);
  for (size_t s = 0; s < servos_.size(); ++s) {
    if (ticks[s].tracked)
      servos_[s].put(ticks[s].contact, seconds(now));
    else
      servos_[s].clear(seconds(now));
  }
  if (updating_) return;
  Wrenches wanted;
  ListeningStyluses there{};
  for (size_t s = 0; s < ticks.size(); ++s) {
    wanted[s] = ticks[s].reaction;
    there[s] = ticks[s].tracked && inputs[s].isActive();
  }
  schedule_.request(wanted, there, now);
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
  return updating_ ? std::min(period_due_, schedule_.due()) : schedule_.due();
}

/// Starts or stops evaluation, depending on tracked styluses that subscribe. Discards the motion of devices when it
/// stops.
void ForceLoop::updateListeners(const Inputs& inputs, SteadyTime now) {
  const ListeningStyluses there = thereOf(inputs);
  const bool updates = between_ticks_ && schedule_.live() && std::find(there.begin(), there.end(), true) != there.end();
  if (updates == updating_) return;
  updating_ = updates;
  period_due_ = now;
  if (updating_) return;
  for (HapticServo& servo : servos_) servo.leave();
  schedule_.request({}, {}, now);
}

Wrenches ForceLoop::next(const Inputs& inputs, SteadyTime now) {
  updateListeners(inputs, now);
  if (updating_ && now >= period_due_) {
    update(inputs, now);
    period_due_ += (1 + (now - period_due_) / period_) * period_;  // missed periods are skipped
  }
  Wrenches out = schedule_.next(now);
  if (!updating_ || !schedule_.live()) return out;
  for (size_t s = 0; s < servos_.size(); ++s) {
    if (!inputs[s].isActive()) continue;
    out[s].force_n = servos_[s].damped(out[s].force_n, seconds(now));
    schedule_.lessened(s, out[s].force_n);
  }
  return out;
}

/// Evaluates the local models at the newest poses.
void ForceLoop::update(const Inputs& inputs, SteadyTime now) {
  Wrenches wanted;
  for (size_t s = 0; s < servos_.size(); ++s) {
    if (!inputs[s].isActive()) {
      if (inputs[s].tracked)
        servos_[s].leave();
      else
        servos_[s].clear(seconds(now));
      continue;
    }
    wanted[s] = servos_[s].step(inputs[s].tip_m, seconds(inputs[s].pose_time), seconds(now));
    ++updates_[s];
  }
  schedule_.request(wanted, thereOf(inputs), now);
}

void ForceLoop::sent(const std::array<Vector3d, layout::kMaxStyluses>& device_forces_n, SteadyTime now) {
  if (!updating_) return;
  for (size_t s = 0; s < servos_.size(); ++s) servos_[s].sent(device_forces_n[s], seconds(now));
}

ForceLoop::HapticStats ForceLoop::stats(size_t stylus) const {
  if (!between_ticks_) return {};
  const HapticServo& servo = servos_[stylus];
  return {servo.passivity().energy_j(), servo.passivity().least_j(), servo.stiffnessScale(), updates_[stylus]};
}

}  // namespace viscera
