// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/device_map.h"
#include "support/source_folder.h"

#include <gtest/gtest.h>

namespace viscera {
namespace {

constexpr double kDeviceMapRounding = 1e-12;  // m, and for components of quaternions: a chain of rotations in double

DeviceProfile profile(const Overrides& overrides) {
  DeviceChoice choice;
  choice.stylus = "left";
  choice.overrides = overrides;
  return parseDevice("about: a\n", "device.yaml", choice);
}

DeviceProfile shipped(const std::string& name) {
  DeviceChoice choice;
  choice.stylus = "left";
  return loadDevice(test::sourceFolder() + "/config/devices/" + name + ".yaml", choice);
}

void expectNear(const Pose& a, const Pose& b) {
  EXPECT_LT((a.position_m - b.position_m).norm(), kDeviceMapRounding);
  EXPECT_LT(a.orientation.angularDistance(b.orientation), 1e-7);  // rounding of the arc cosine
}

const Pose kStylus{{0.01, 0.02, 0.03}, rotationFromDegrees({20, -30, 70})};

TEST(DeviceMap, LeavesACrtkDeviceAsItIs) {
  DeviceMap map(profile({}));
  expectNear(map.toBase(kStylus), kStylus);
  EXPECT_FALSE(map.base());
}

TEST(DeviceMap, TurnsAxesAndUnits) {
  DeviceMap map(profile({"pose.unit_m=0.001", "pose.axes=x -z y"}));
  const Pose tip = map.toBase({{10, 20, 30}, Quaterniond::Identity()});
  EXPECT_LT((tip.position_m - Vector3d(0.01, -0.03, 0.02)).norm(), kDeviceMapRounding);
  EXPECT_LT((tip.orientation * Vector3d::UnitY() - Vector3d::UnitZ()).norm(), kDeviceMapRounding);
  EXPECT_LT((map.axesFromBase() * Vector3d::UnitZ() - Vector3d::UnitY()).norm(),
            kDeviceMapRounding);  // an upward force
}

TEST(DeviceMap, TipIsInTheFrameOfThePose) {
  DeviceMap map(profile({"tip.position_m=[0,0,-0.1]", "pose.axes=-x -y z"}));
  const Pose tip = map.toBase({{0, 0, 0.5}, rotationFromDegrees({90, 0, 0})});
  EXPECT_LT((tip.position_m - Vector3d(0, -0.1, 0.5)).norm(), kDeviceMapRounding);
  EXPECT_LT((map.leverArm({{0, 0, 0.5}, rotationFromDegrees({90, 0, 0})}) - Vector3d(0, -0.1, 0)).norm(),
            kDeviceMapRounding);
}

TEST(DeviceMap, ThereAndBack) {
  DeviceMap map(profile({"pose.unit_m=0.001", "pose.axes=y z x", "pose.turn_axes=x -z y", "scale=0.5",
                         "tip={position_m: [0.01, 0, -0.1], orientation_xyzw: [0, 0, 1, 0]}"}));
  expectNear(map.fromBase(map.toBase(kStylus)), kStylus);
}

TEST(DeviceMap, ScaleIsOfTheTipsWay) {
  DeviceMap map(profile({"scale=0.25", "tip.position_m=[0,0,-0.1]"}));
  const Vector3d before_m = map.toBase({{0, 0, 0}, Quaterniond::Identity()}).position_m;
  const Vector3d after_m = map.toBase({{0.04, 0, 0}, Quaterniond::Identity()}).position_m;
  EXPECT_LT((after_m - before_m - Vector3d(0.01, 0, 0)).norm(), kDeviceMapRounding);
}

TEST(DeviceMap, ClutchHoldsThePositionAndNotTheTurn) {
  DeviceMap map(profile({"scale=2"}));
  const Vector3d held_m = map.toBase(kStylus).position_m;
  map.setClutch(true);
  Pose moved = kStylus;
  moved.position_m += Vector3d(0.03, 0, 0);
  moved.orientation = Quaterniond::Identity();
  const Pose while_clutched = map.toBase(moved);
  EXPECT_LT((while_clutched.position_m - held_m).norm(), kDeviceMapRounding);
  EXPECT_LT(while_clutched.orientation.angularDistance(moved.orientation), 1e-7);
  map.setClutch(false);
  EXPECT_LT((map.toBase(moved).position_m - held_m).norm(), kDeviceMapRounding);  // no jump
  moved.position_m += Vector3d(0, 0.01, 0);
  EXPECT_LT((map.toBase(moved).position_m - held_m - Vector3d(0, 0.02, 0)).norm(), kDeviceMapRounding);
  map.setClutch(true);
  map.setClutch(false);
  expectNear(map.fromBase(map.toBase(moved)), moved);
}

TEST(DeviceMap, ClutchThatIsDownAtTheStartHoldsTheFirstPosition) {
  DeviceMap map(profile({}));
  map.setClutch(true);
  const Vector3d first_m = map.toBase(kStylus).position_m;
  Pose moved = kStylus;
  moved.position_m.x() += 1;
  EXPECT_LT((map.toBase(moved).position_m - first_m).norm(), kDeviceMapRounding);
}

TEST(DeviceMap, PositionThatIsNotAcceptedMovesNoClutch) {
  DeviceMap map(profile({}));
  const Vector3d good_m = map.toBase(kStylus).position_m;
  Pose far = kStylus;
  far.position_m.x() = 100;
  EXPECT_EQ(map.tipOf(far).tip.position_m.x(), 100);
  map.setClutch(true);
  EXPECT_LT((map.tipOf(far).tip.position_m - good_m).norm(), kDeviceMapRounding);
  map.setClutch(false);
  expectNear(map.toBase(kStylus), kStylus);
}

/// For the dVRK, z of the tip's frame points out of the instrument, along its jaws; the shaft is behind it.
TEST(DeviceMap, ToolsOfTheDvrkPointAsTheirInstrumentsDo) {
  for (const char* name : {"dvrk_mtm", "crtk_arm"}) {
    DeviceMap map(shipped(name));
    const Quaterniond jaws = rotationFromDegrees({20, -30, 70});
    const Pose tip = map.toBase({{0.01, 0.02, 0.03}, jaws});
    EXPECT_LT((tip.position_m - Vector3d(0.01, 0.02, 0.03)).norm(), kDeviceMapRounding) << name;
    const Vector3d ahead = tip.orientation * -Vector3d::UnitZ();  // as in docs/user_guide.md
    EXPECT_LT((ahead - jaws * Vector3d::UnitZ()).norm(), kDeviceMapRounding) << name;
    expectNear(map.fromBase(tip), {{0.01, 0.02, 0.03}, jaws});
  }
}

TEST(DeviceMap, ArmStartsWithItsJawsTowardsTheTissue) {
  const DeviceProfile arm = shipped("crtk_arm");
  const Quaterniond start = rotationFromDegrees(arm.arm.start_rotation_deg);
  const Vector3d jaws = start * Vector3d::UnitZ(), towards_tissue = Vector3d(0, -arm.arm.start_m.y(), 0).normalized();
  EXPECT_LT((jaws - towards_tissue).norm(), kDeviceMapRounding);
  const Pose tool = DeviceMap(arm).tipOf({arm.arm.start_m, start}).tip;
  EXPECT_LT((tool.orientation * -Vector3d::UnitZ() - towards_tissue).norm(), kDeviceMapRounding);
}

/// As in omni_common: the position is rotated to z up; the orientation is the device's times a quarter turn about z.
TEST(DeviceMap, OmnisStylusPointsWhereItDoesInTheHand) {
  DeviceMap map(shipped("phantom_omni"));
  const Quaterniond in_device = rotationFromDegrees({20, -30, 70});  // y up
  const Quaterniond quarter(Eigen::AngleAxisd(-M_PI / 2, Vector3d::UnitZ()));
  const Quaterniond up(axesOf("x -z y", ""));
  const Pose tip = map.toBase({{0, 0, 0}, in_device * quarter});
  EXPECT_LT(tip.orientation.angularDistance(up * in_device), 1e-6);  // the profile has eight decimals
}

}  // namespace
}  // namespace viscera
