// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/simulated_device.h"

#include <cmath>

namespace viscera {
namespace {

constexpr int kSubsteps = 10;
constexpr double kTurn = 6.283185307179586;
/// Frequencies of the tremor along x, y, z [Hz]: no two in phase.
constexpr double kTremor_hz[3] = {8.3, 9.7, 11.1};

Vector3d inSteps(const Vector3d& at_m, double step_m) {
  if (!(step_m > 0)) return at_m;
  return (at_m / step_m).array().round().matrix() * step_m;
}

size_t periods(double span_s, double period_s) {
  return static_cast<size_t>(std::lround(span_s / period_s));
}

}  // namespace

SimulatedDevice::SimulatedDevice(const SimulatedDeviceConfig& config, const Vector3d& at_m)
    : config_(config), at_m_(at_m), user_m_(at_m), reported_m_(inSteps(at_m, config.encoder_m)) {
  const size_t all = periods(config.delay_s, config.period_s);
  measured_.assign(all / 2 + 1, reported_m_);
  commanded_.assign(all - all / 2, Vector3d::Zero());
}

Vector3d SimulatedDevice::tremor() const {
  Vector3d out;
  for (int k = 0; k < 3; ++k) out[k] = config_.tremor_m * std::sin(kTurn * kTremor_hz[k] * time_s_);
  return out;
}

void SimulatedDevice::step(const Vector3d& force_n, const Vector3d& user_m) {
  acting_n_ = force_n;
  if (!commanded_.empty()) {
    acting_n_ = commanded_[next_commanded_];
    commanded_[next_commanded_] = force_n;
    next_commanded_ = (next_commanded_ + 1) % commanded_.size();
  }
  const double size = acting_n_.norm();
  if (size > config_.most_force_n) acting_n_ *= config_.most_force_n / size;

  const double dt = config_.period_s / kSubsteps;
  const Vector3d hand_before = user_m_;
  const Vector3d hand_velocity = (user_m - hand_before) / config_.period_s;
  const double drag = config_.damping_n_s_per_m + config_.hand_damping_n_s_per_m;
  for (int i = 1; i <= kSubsteps; ++i) {
    time_s_ += dt;
    const Vector3d wanted = hand_before + i * dt * hand_velocity + tremor();
    const Vector3d pull =
        config_.hand_stiffness_n_per_m * (wanted - at_m_) + config_.hand_damping_n_s_per_m * hand_velocity + acting_n_;
    velocity_ = (velocity_ + dt / config_.mass_kg * pull) / (1 + dt * drag / config_.mass_kg);
    at_m_ += dt * velocity_;
    energy_j_ -= dt * acting_n_.dot(velocity_);
  }
  user_m_ = user_m;
  reported_m_ = inSteps(at_m_, config_.encoder_m);
  measured_[next_measured_] = reported_m_;
  next_measured_ = (next_measured_ + 1) % measured_.size();
}

}  // namespace viscera
