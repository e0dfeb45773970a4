// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/haptic_servo.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "viscera/haptics/simulated_device.h"

namespace viscera {
namespace {

constexpr double kTick_s = 1.0 / 60, kStiff_n_per_m = 800;

/// A device presses a wall of springs that answers once per tick, half a tick late.
struct Pressed {
  double swing_m = 0, force_n = 0, least_j = 0, share = 1;
};
Pressed press(double mass_kg, double delay_s, bool servoed) {
  SimulatedDeviceConfig device_config;
  device_config.mass_kg = mass_kg;
  device_config.delay_s = delay_s;
  SimulatedDevice device(device_config, {0, 0, 0.002});
  HapticServoConfig config;
  config.tick_s = kTick_s;
  config.round_trip_s = delay_s;
  config.tissue = {1e5, 1e5, 0.25, 0.008};
  HapticServo servo(config);
  Pressed out;
  TickContact contact;
  Vector3d last(0, 0, 0.002), told = Vector3d::Zero();
  double next_s = 0, answer_s = 1e9, low = 1e9, high = -1e9;
  for (int i = 0; i < 6000; ++i) {
    const double now_s = 1e-3 * i;
    const Vector3d tip = device.measured_m();
    if (now_s >= next_s) {
      next_s += kTick_s;
      answer_s = now_s + 0.5 * kTick_s;
      contact = {};
      contact.from_m = last;
      contact.to_m = last = tip;
      const double push = -kStiff_n_per_m * 0.5 * (contact.from_m.z() + contact.to_m.z());
      if (push > 0) contact.kind = TickContact::Kind::kPushes;
      contact.reaction.force_n = {0, 0, std::max(push, 0.0)};
    }
    if (now_s >= answer_s) {
      servo.put(contact, now_s);
      answer_s = 1e9;
      if (!servoed) told = contact.reaction.force_n;
    }
    const Reaction reaction = servo.step(tip, now_s, now_s);
    if (servoed) told = reaction.force_n;
    device.step(told, {0, 0, std::max(0.002 - 0.01 * now_s, -0.004)});
    out.least_j = std::min(out.least_j, device.energy_j());
    if (i < 5500) continue;
    low = std::min(low, device.position_m().z());
    high = std::max(high, device.position_m().z());
  }
  out.swing_m = 0.5 * (high - low);
  out.force_n = told.z();
  out.share = servo.share();
  return out;
}

/// Half of what an encoder's step makes of itself.
constexpr double kQuiet_m = 2e-5;
const double kBalance_n = 0.004 / (1 / kStiff_n_per_m + 1 / SimulatedDeviceConfig{}.hand_stiffness_n_per_m);

TEST(HapticServo, HoldsAStiffWallStillWhereTicksAloneSwing) {
  EXPECT_GT(press(0.1, 0, false).swing_m, 10 * kQuiet_m);
  const Pressed held = press(0.1, 0, true);
  EXPECT_LT(held.swing_m, kQuiet_m);
  EXPECT_NEAR(held.force_n, kBalance_n, 0.02 * kBalance_n);
  EXPECT_GT(held.least_j, -1e-3);
}

TEST(HapticServo, SoftensWhatALightDeviceBehindADelayCannotHold) {
  const Pressed held = press(0.05, 0.01, true);
  EXPECT_LT(held.share, 0.5);
  EXPECT_LT(held.swing_m, kQuiet_m);
  EXPECT_NEAR(held.force_n, kBalance_n, 0.02 * kBalance_n);
}

TEST(HapticServo, SoftensNothingForAHeavierOne) {
  EXPECT_GT(press(0.3, 0.005, true).share, 0.95);
}

TEST(HapticServo, ForgetsAtOnceWhatItKnew) {
  HapticServo servo(HapticServoConfig{});
  TickContact contact;
  contact.kind = TickContact::Kind::kPushes;
  contact.reaction.force_n = {0, 0, 1};
  servo.put(contact, 0);
  EXPECT_GT(servo.step(Vector3d::Zero(), kTick_s, kTick_s).force_n.z(), 0.9);
  servo.forget(kTick_s);
  EXPECT_EQ(servo.step({0.1, 0.1, 0.1}, 3 * kTick_s, 3 * kTick_s).force_n, Vector3d(0, 0, 0));
}

}  // namespace
}  // namespace viscera
