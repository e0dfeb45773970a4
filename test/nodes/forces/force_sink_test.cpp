// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/forces/force_sink.h"

#include <gtest/gtest.h>

namespace viscera::nodes {
namespace {

constexpr double kRounding = 1e-12;  // N, N m: several products in double

TEST(ForceSink, TurnsIntoTheDevicesAxesAndAboutTheOriginOfItsPoses) {
  DeviceFrame frame;
  frame.from_tissue = Quaterniond(axesOf("x -z y", "")).conjugate();
  frame.lever_arm_m = {0, 0, -0.1};
  const Reaction out = toDevice({{1, 0, 2}, {0, 0, 0.01}, false}, frame, {});
  EXPECT_LT((out.force_n - Vector3d(1, 2, 0)).norm(), kRounding);  // up is the device's y
  EXPECT_LT((out.torque_nm - Vector3d(0.2, 0.01 - 0.1, 0)).norm(), kRounding);
  EXPECT_FALSE(out.saturated);
}

TEST(ForceSink, NeverGivesMoreThanTheDeviceIsMadeFor) {
  ForcePort port;
  port.scale = 10;
  port.max_force_n = 3;
  port.max_torque_nm = 0.1;
  const Reaction strong = toDevice({{0, 1, 0}, {0, 0, 0.005}, false}, {}, port);
  EXPECT_LT((strong.force_n - Vector3d(0, 3, 0)).norm(), kRounding);
  EXPECT_LT((strong.torque_nm - Vector3d(0, 0, 0.015)).norm(), kRounding);
  EXPECT_TRUE(strong.saturated);
  const Reaction twisting = toDevice({{0, 0.1, 0}, {0, 0, 0.05}, false}, {}, port);
  EXPECT_LT((twisting.torque_nm - Vector3d(0, 0, 0.1)).norm(), kRounding);
  EXPECT_LT((twisting.force_n - Vector3d(0, 0.2, 0)).norm(), kRounding);
}

TEST(ForceSink, NoTorqueShrinksTheForceOfADeviceThatHasNone) {
  DeviceFrame frame;
  frame.lever_arm_m = {0.1, 0, 0};
  for (const ForceType type : {ForceType::kOmniFeedback, ForceType::kGeomagicFeedback}) {
    ForcePort port;
    port.type = type;
    port.max_torque_nm = 0.01;
    const Reaction out = toDevice({{0, 0, 1}, {0, 0.3, 0}, false}, frame, port);
    EXPECT_EQ(out.force_n, Vector3d(0, 0, 1));
    EXPECT_EQ(out.torque_nm, Vector3d::Zero());
  }
  ForcePort without;
  without.max_torque_nm = 0;
  EXPECT_EQ(toDevice({{0, 0, 1}, {0, 0.3, 0}, false}, frame, without).force_n, Vector3d(0, 0, 1));
}

}  // namespace
}  // namespace viscera::nodes
