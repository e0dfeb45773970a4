// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/haptic_loop.h"

#include <algorithm>

namespace viscera::nodes {
namespace {

/// Nobody knows which body a stylus will touch.
TissueConstants tissueOf(const Scene& scene, const StylusConfig& stylus) {
  std::vector<double> moduli_pa;
  for (const BodyConfig& body : scene.bodies) {
    moduli_pa.push_back(body.material.young_modulus_pa);
    for (const PartConfig& part : body.parts) moduli_pa.push_back(part.young_modulus_pa);
  }
  TissueConstants out;
  out.tip_radius_m = stylus.probe.radius_m;
  if (moduli_pa.empty()) return out;
  out.softest_pa = *std::min_element(moduli_pa.begin(), moduli_pa.end());
  out.stiffest_pa = *std::max_element(moduli_pa.begin(), moduli_pa.end());
  out.poisson_ratio = scene.bodies[0].material.poisson_ratio;
  return out;
}

}  // namespace

HapticLoop::HapticLoop(const HapticOptions& options, const Scene& scene,
                       const std::vector<const StylusMailbox*>& mailboxes)
    : options_(options),
      mailboxes_(mailboxes),
      answers_(mailboxes.size(), 0),
      begun_(std::chrono::steady_clock::now()) {
  if (!on()) return;
  for (const StylusMailbox* mailbox : mailboxes_) {
    HapticServoConfig config;
    config.period_s = period_s();
    config.tick_s = 1 / scene.solver.tick_hz;
    config.round_trip_s = mailbox->device().delay_s > 0 ? mailbox->device().delay_s : options_.delay_s;
    config.tissue = tissueOf(scene, mailbox->config());
    servos_.emplace_back(config);
  }
}

void HapticLoop::put(size_t stylus, const TickContact& contact, bool tracked, SteadyTime now) {
  if (!on()) return;
  if (tracked)
    servos_[stylus].put(contact, seconds(now));
  else
    servos_[stylus].forget(seconds(now));
}

void HapticLoop::rest(SteadyTime now) {
  for (HapticServo& servo : servos_) servo.forget(seconds(now));
}

Wrenches HapticLoop::answers(SteadyTime now, std::array<SteadyTime, layout::kMaxStyluses>& received) {
  Wrenches out;
  received = {};
  for (size_t s = 0; s < servos_.size(); ++s) {
    const StylusSample sample = mailboxes_[s]->peek(now);
    if (!sample.valid || mailboxes_[s]->clutched()) {
      servos_[s].forget(seconds(now));
      continue;
    }
    out[s] = servos_[s].step(sample.pose.position_m, seconds(sample.received), seconds(now));
    received[s] = sample.received;
    ++answers_[s];
  }
  return out;
}

void HapticLoop::sent(const Wrenches& wrenches) {
  for (size_t s = 0; s < servos_.size(); ++s) servos_[s].sent(wrenches[s].force_n);
}

HapticLoop::Felt HapticLoop::felt(size_t stylus) const {
  if (!on()) return {};
  const HapticServo& servo = servos_[stylus];
  return {servo.passivity().energy_j(), servo.passivity().least_j(), servo.share(), answers_[stylus]};
}

}  // namespace viscera::nodes
