// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/forces/impedance.h"

#include <gtest/gtest.h>

#include <chrono>

#include "nodes/forces/force_sink.h"
#include "viscera/model/scene/stylus_config.h"

namespace viscera::nodes {
namespace {

constexpr double kTick_s = 0.02, kStiff_n_per_m = 300;
constexpr double kImpedanceRounding = 1e-9;  // N, m: several products in double

const SteadyTime kNow{std::chrono::hours(1)};

/// Returns a servo after ticks with a tip 2 mm deep in a wall at z = 0.
HapticServo pressed() {
  HapticServoConfig config;
  config.tick_s = kTick_s;
  HapticServo servo(config);
  double at_m = 0, now_s = 3600 - 9 * kTick_s;
  for (int i = 0; i < 8; ++i) {
    TickContact contact;
    contact.from_m.z() = at_m;
    contact.to_m.z() = at_m -= 2.5e-4;
    contact.kind = TickContact::Kind::kPushes;
    contact.reaction.force_n.z() = -0.5 * kStiff_n_per_m * (contact.from_m.z() + contact.to_m.z());
    servo.put(contact, now_s += kTick_s);
  }
  return servo;
}

/// Sends a pose at height z in the tissue frame, by a device with this profile.
void tell(StylusMailbox& mailbox, const DeviceProfile& device, double z_m) {
  DevicePose said;
  const DeviceMap map(device);
  said.pose = map.fromBase(device.base.pose().inverse() * Pose{{0, 0, z_m}, Quaterniond::Identity()});
  said.stamp = ros::Time(10);
  ASSERT_FALSE(mailbox.put(said, {}, {kNow, ros::Time(10)}));
  mailbox.take(kNow);
  mailbox.take(kNow);
}

/// Returns the force of a device with this impedance at one of its positions, in its own axes.
Vector3d forceAt(const crtk_msgs::CartesianImpedance& it, const Vector3d& device_m) {
  const auto vector = [](const geometry_msgs::Vector3& v) { return Vector3d(v.x, v.y, v.z); };
  const Quaterniond axes(it.force_orientation.w, it.force_orientation.x, it.force_orientation.y,
                         it.force_orientation.z);
  const Vector3d e_m = axes.conjugate() * (device_m - vector(it.force_position));
  Vector3d force_n = Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const auto& side = e_m[k] > 0 ? it.position_positive : it.position_negative;
    force_n[k] = vector(side.bias)[k] + vector(side.p)[k] * e_m[k];
  }
  return axes * force_n;
}

TEST(Impedance, IsTheForceThatGoesOutWhateverStandsBetweenDeviceAndTool) {
  const HapticServo servo = pressed();
  for (const bool plain : {true, false}) {
    DeviceProfile device;
    if (!plain) {
      device.pose.axes = "x -z y";
      device.scale = 0.5;
      device.force.scale = 2;
      device.base.given = true;
      device.base.position_m = {0.1, 0.2, 0.3};
      device.base.orientation = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized());
    }
    StylusMailbox mailbox(StylusConfig{}, "tissue", device);
    tell(mailbox, device, -0.0015);
    const crtk_msgs::CartesianImpedance out = toImpedance(servo, mailbox, 5, kNow, ros::Time(10));
    EXPECT_EQ(out.header.frame_id, mailbox.deviceFrame().name);
    const Vector3d tip_m(0, 0, -0.0015);
    const Vector3d wanted_n = servo.model().at(tip_m, 3600).force_n;
    const Vector3d sent_force_n =
        toDevice({wanted_n, Vector3d::Zero(), false}, mailbox.deviceFrame(), device.force).force_n;
    const Vector3d position_m = mailbox.inDevice({tip_m, Quaterniond::Identity()}).position_m;
    ASSERT_GT(wanted_n.z(), 0.3);
    EXPECT_LT((forceAt(out, position_m) - sent_force_n).norm(), kImpedanceRounding) << plain;
  }
}

TEST(Impedance, GivesNoMoreThanTheStylusMay) {
  DeviceProfile device;
  StylusMailbox mailbox(StylusConfig{}, "tissue", device);
  tell(mailbox, device, -0.0015);
  const crtk_msgs::CartesianImpedance out = toImpedance(pressed(), mailbox, 0.1, kNow, ros::Time(10));
  EXPECT_NEAR(forceAt(out, {0, 0, -0.0015}).norm(), 0.1, kImpedanceRounding);
}

TEST(Impedance, IsNothingForAStylusThatHasTheClutchOrIsNotThere) {
  DeviceProfile device;
  StylusMailbox mailbox(StylusConfig{}, "tissue", device);
  const HapticServo servo = pressed();
  EXPECT_EQ(toImpedance(servo, mailbox, 5, kNow, ros::Time(10)).position_negative.p.z, 0);
  tell(mailbox, device, -0.0015);
  EXPECT_LT(toImpedance(servo, mailbox, 5, kNow, ros::Time(10)).position_negative.p.z, 0);
  mailbox.press(ButtonRole::kClutch, {1}, 0, kNow);
  EXPECT_EQ(toImpedance(servo, mailbox, 5, kNow, ros::Time(10)).position_negative.p.z, 0);
}

}  // namespace
}  // namespace viscera::nodes
