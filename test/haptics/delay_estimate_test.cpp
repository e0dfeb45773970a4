// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/delay_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "viscera/haptics/simulated_device.h"

namespace viscera {
namespace {

constexpr double kDelayPeriod_s = 1e-3, kDelayPi = 3.14159265358979;
/// Of the estimate [s]: it compares round trips that are 2 ms apart, and a pose is from within a period.
constexpr double kDelayNear_s = 3e-3;
constexpr double kDelayLongest_s = 0.01;

/// A held device that is pushed five times a second, by a force that knows nothing of it, or not at all.
DelayEstimate heard(double delay_s, double told_s, double force_n, double mass_kg = 0.2, int periods_per_pose = 1) {
  SimulatedDeviceConfig config;
  config.mass_kg = mass_kg;
  config.delay_s = delay_s;
  SimulatedDevice device(config, Vector3d::Zero());
  SentForces sent(0.2, kDelayPeriod_s);
  DelayEstimate out(told_s, kDelayLongest_s);
  for (int i = 0; i < 2000; ++i) {
    const double now_s = i * kDelayPeriod_s, in_s = std::fmod(now_s, 0.2);
    const Vector3d force(0, 0, in_s < 0.05 ? force_n * std::sin(kDelayPi * in_s / 0.05) : 0);
    if (i % periods_per_pose == 0) out.heard(device.measured_m(), now_s, sent);
    sent.add(force, now_s);
    device.step(force, {0.01 * std::sin(3 * now_s), 0, 0});
  }
  return out;
}

TEST(DelayEstimate, FindsADelayThatWasToldTooShort) {
  for (const double mass_kg : {0.05, 0.2, 0.7}) {
    for (const int periods : {1, 4, 10}) {
      SCOPED_TRACE(std::to_string(mass_kg) + " kg, " + std::to_string(periods) + " ms");
      EXPECT_NEAR(heard(0.01, 0.002, 1, mass_kg, periods).likely_s(), 0.01, kDelayNear_s);
    }
  }
}

TEST(DelayEstimate, KeepsToWhatWasToldRight) {
  for (const double delay_s : {0.002, 0.006, 0.01}) {
    SCOPED_TRACE(delay_s);
    const DelayEstimate estimate = heard(delay_s, delay_s, 1);
    EXPECT_NEAR(estimate.likely_s(), delay_s, 1e-9 + 2e-3);
    EXPECT_LE(estimate.longest_s(), delay_s + kDelayNear_s);
  }
}

TEST(DelayEstimate, ExcludesNothingBeforeForcesTell) {
  const DelayEstimate estimate = heard(0.002, 0.002, 0);
  EXPECT_EQ(estimate.likely_s(), 0.002);
  EXPECT_EQ(estimate.longest_s(), kDelayLongest_s);
  EXPECT_EQ(DelayEstimate(0.03, kDelayLongest_s).longest_s(), 0.03);
}

}  // namespace
}  // namespace viscera
