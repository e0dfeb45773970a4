// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/haptic_servo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "viscera/haptics/simulated_device.h"

namespace viscera {
namespace {

constexpr double kHapticServoTick_s = 1.0 / 60, kHapticServoStiff_n_per_m = 800;

/// Properties of a held device and its driver.
struct Held {
  double mass_kg = 0.1, delay_s = 0;
  bool servoed = true;
  int periods_per_pose = 1;  ///< one period is 1 ms
  double motion_scale = 1, force_scale = 1;
};

/// A device presses a wall of springs that answers once per tick, half a tick late. Positions are those of the device.
struct Pressed {
  double swing_m = 0, force_n = 0, least_j = 0, observed_j = 0, energy_j = 0, device_j = 0, share = 1;
};
Pressed press(const Held& held) {
  SimulatedDeviceConfig device_config;
  device_config.mass_kg = held.mass_kg;
  device_config.delay_s = held.delay_s;
  SimulatedDevice device(device_config, {0, 0, 0.002});
  HapticServoConfig config;
  config.tick_s = kHapticServoTick_s;
  config.round_trip_s = held.delay_s;
  config.motion_scale = held.motion_scale;
  config.force_scale = held.force_scale;
  config.tissue = {1e5, 1e5, 0.25, 0.008};
  HapticServo servo(config);
  Pressed out;
  TickContact contact;
  Vector3d tip = held.motion_scale * device.measured_m(), last = tip, reported = Vector3d::Zero();
  double next_s = 0, answer_s = 1e9, pose_time_s = 0, low = 1e9, high = -1e9;
  const double stiff = kHapticServoStiff_n_per_m / (held.motion_scale * held.force_scale);  // at the tip
  for (int i = 0; i < 6000; ++i) {
    const double now_s = 1e-3 * i;
    if (i % held.periods_per_pose == 0) {
      tip = held.motion_scale * device.measured_m();
      pose_time_s = now_s;
    }
    if (now_s >= next_s) {
      next_s += kHapticServoTick_s;
      answer_s = now_s + 0.5 * kHapticServoTick_s;
      contact = {};
      contact.from_m = last;
      contact.to_m = last = tip;
      const double push = -stiff * 0.5 * (contact.from_m.z() + contact.to_m.z());
      if (push > 0) contact.kind = TickContact::Kind::kPushes;
      contact.reaction.force_n = {0, 0, std::max(push, 0.0)};
    }
    if (now_s >= answer_s) {
      servo.put(contact, now_s);
      answer_s = 1e9;
      if (!held.servoed) reported = held.force_scale * contact.reaction.force_n;
    }
    const Vector3d answer = servo.damped(servo.step(tip, pose_time_s, now_s).force_n, now_s);
    if (held.servoed) reported = held.force_scale * answer;
    servo.sent(reported, now_s);
    device.step(reported, {0, 0, std::max(0.002 - 0.01 * now_s, -0.004)});
    out.least_j = std::min(out.least_j, device.energy_j());
    if (i < 5500) continue;
    low = std::min(low, device.position_m().z());
    high = std::max(high, device.position_m().z());
  }
  out.swing_m = 0.5 * (high - low);
  out.force_n = reported.z();
  out.share = servo.stiffnessScale();
  out.energy_j = servo.passivity().energy_j();
  out.observed_j = servo.passivity().least_j();
  out.device_j = device.energy_j();
  return out;
}

/// Half of the oscillation due to an encoder step.
constexpr double kQuiet_m = 2e-5;
/// Tolerance of the observer's energy against the device's [J]: a twentieth of the permitted energy.
constexpr double kBooked_j = 5e-5;
const double kBalance_n = 0.004 / (1 / kHapticServoStiff_n_per_m + 1 / SimulatedDeviceConfig{}.hand_stiffness_n_per_m);

TEST(HapticServo, HoldsAStiffWallStillWhereTicksAloneSwing) {
  EXPECT_GT(press({0.1, 0, false}).swing_m, 10 * kQuiet_m);
  const Pressed held = press({0.1, 0});
  EXPECT_LT(held.swing_m, kQuiet_m);
  EXPECT_NEAR(held.force_n, kBalance_n, 0.02 * kBalance_n);
  EXPECT_GT(held.least_j, -1e-3);
}

TEST(HapticServo, SoftensWhatALightDeviceBehindADelayCannotHold) {
  const Pressed held = press({0.05, 0.01});
  EXPECT_LT(held.share, 0.5);
  EXPECT_LT(held.swing_m, kQuiet_m);
  EXPECT_NEAR(held.force_n, kBalance_n, 0.02 * kBalance_n);
}

TEST(HapticServo, SoftensNothingForAHeavierOne) {
  EXPECT_GT(press({0.3, 0.005}).share, 0.95);
}

/// Drivers of 60 Hz, 100 Hz (ros_geomagic), 250 Hz: the device moves between two poses.
TEST(HapticServo, HoldsAStiffWallStillWithFewPoses) {
  for (const int periods : {4, 10, 16}) {
    for (const double mass_kg : {0.05, 0.1, 0.5}) {
      SCOPED_TRACE(std::to_string(periods) + " ms, " + std::to_string(mass_kg) + " kg");
      Held how;
      how.mass_kg = mass_kg;
      how.periods_per_pose = periods;
      const Pressed held = press(how);
      EXPECT_LT(held.swing_m, kQuiet_m);
      EXPECT_NEAR(held.force_n, kBalance_n, 0.02 * kBalance_n);
      EXPECT_GT(held.least_j, -1e-3);
    }
  }
}

/// The observer has the device's own energy, with any scales between device and tool.
TEST(HapticServo, CountsWhatTheUserGivesWhateverTheScales) {
  for (const auto& [motion, force] : {std::pair{1.0, 1.0}, {0.2, 1.0}, {1.0, 2.0}, {3.0, 0.5}}) {
    SCOPED_TRACE(std::to_string(motion) + ", " + std::to_string(force));
    Held how;
    how.motion_scale = motion;
    how.force_scale = force;
    const Pressed held = press(how);
    EXPECT_LT(held.swing_m, kQuiet_m);
    EXPECT_GT(std::abs(held.device_j), 2 * kBooked_j);
    EXPECT_NEAR(held.energy_j, held.device_j, kBooked_j);
  }
}

/// During a gap, neither the motion nor the force is known.
TEST(HapticServo, AGapIsNoMotion) {
  HapticServo servo(HapticServoConfig{});
  TickContact contact;
  contact.kind = TickContact::Kind::kPushes;
  contact.reaction.force_n = {0, 0, 1};
  servo.put(contact, 0);
  double now_s = 0;
  for (int i = 0; i < 100; ++i, now_s += 1e-3) servo.sent(servo.step(Vector3d::Zero(), now_s, now_s).force_n, now_s);
  servo.leave();
  now_s += 0.15;
  servo.put(contact, now_s);
  servo.step({0, 0, 0.03}, now_s, now_s);
  EXPECT_EQ(servo.passivity().energy_j(), 0);
  EXPECT_EQ(servo.passivity().least_j(), 0);
}

/// After a grip's force reverses, no force in the old direction remains, however soft the loop is.
TEST(HapticServo, SoftenedForcesKeepTheirDirection) {
  HapticServoConfig config;
  config.round_trip_s = 0.01;
  config.tissue = {1e5, 1e5, 0.25, 0.008};
  HapticServo servo(config);
  TickContact contact;
  contact.kind = TickContact::Kind::kHolds;
  // A device that oscillates ten times a second against its force, as one with a delay does: the loop softens.
  double now_s = 0, z_m = 0;
  for (int i = 0; i < 3000; ++i, now_s += 1e-3) {
    const double next_m = 2e-3 * std::sin(6.283 * 10 * now_s);
    if (i % 16 == 0) {
      contact.from_m = contact.to_m = {0, 0, next_m};
      contact.reaction.force_n = {0, 0, 1 - 500 * next_m};
      servo.put(contact, now_s);
    }
    servo.step({0, 0, next_m}, now_s, now_s);
    servo.sent({0, 0, std::cos(6.283 * 10 * now_s)}, now_s);
    z_m = next_m;
  }
  ASSERT_LT(servo.stiffnessScale(), 0.5);
  contact.from_m = contact.to_m = {0, 0, z_m};
  contact.reaction.force_n = {0, 0, 1};
  for (int i = 0; i < 1000; ++i, now_s += 1e-3) servo.step({0, 0, z_m}, now_s, now_s);
  contact.reaction.force_n = {0, 0, -1};  // now in the opposite direction
  servo.put(contact, now_s);
  for (int i = 0; i < 200; ++i, now_s += 1e-3) {
    const double wanted_n = servo.model().at({0, 0, z_m}, now_s).force_n.z();
    const double sent_force_n = servo.step({0, 0, z_m}, now_s, now_s).force_n.z();
    EXPECT_GE(sent_force_n * wanted_n, 0) << i << " ms: " << sent_force_n << " N told, " << wanted_n << " N wanted";
  }
}

TEST(HapticServo, ForgetsAtOnceWhatItKnew) {
  HapticServo servo(HapticServoConfig{});
  TickContact contact;
  contact.kind = TickContact::Kind::kPushes;
  contact.reaction.force_n = {0, 0, 1};
  servo.put(contact, 0);
  EXPECT_GT(servo.step(Vector3d::Zero(), kHapticServoTick_s, kHapticServoTick_s).force_n.z(), 0.9);
  servo.clear(kHapticServoTick_s);
  EXPECT_EQ(servo.step({0.1, 0.1, 0.1}, 3 * kHapticServoTick_s, 3 * kHapticServoTick_s).force_n, Vector3d(0, 0, 0));
}

}  // namespace
}  // namespace viscera
