// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Instruments with shafts that pass a point of the body wall, from the keys of a scene on.
#include "viscera/tools/trocar.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "viscera/model/scene/scene.h"
#include "viscera/tools/tools.h"

namespace viscera {
namespace {

const Vector3d kPoint_m(0.01, -0.02, 0.1);
constexpr double kShaft_m = 0.3;
constexpr double kPasses_m = 1e-9;  ///< largest distance of the shaft from the point at the ends of ticks
/// The same in the middle of a tick in which the tip moves by 4 mm, 1 cm or more from the point: its path is straight,
/// and the shaft turns evenly, so they part by up to (4 mm)^2 / (8 x 1 cm).
constexpr double kPassesBetween_m = 2e-4;
constexpr double kSameWork = 0.01;  ///< relative difference of the works at device and tip

StylusConfig stylusWith(const std::string& follows) {
  return parseScene(
             "bodies: [{source: box}]\nstyluses:\n  - name: left\n    shaft_length_m: 0.3\n    trocar: {follows: " +
                 follows + ", position_m: [0.01, -0.02, 0.1]}\n",
             "trocar.yaml")
      .styluses[0];
}
double missOf(const Pose& tool) {
  const Vector3d axis = tool.orientation * Vector3d::UnitZ(), to = kPoint_m - tool.position_m;
  return (to - axis * axis.dot(to)).norm();
}

/// Poses of a device near one that has its tip 10 cm below the point.
class TrocarTest : public ::testing::TestWithParam<const char*> {
 protected:
  TrocarTest() : stylus_(stylusWith(GetParam())), trocar_(stylus_) {}
  bool atHandle() const { return std::string(GetParam()) == "handle"; }
  double random(double most) { return std::uniform_real_distribution<double>(-most, most)(source_); }
  Vector3d randomVector(double most) { return {random(most), random(most), random(most)}; }
  /// @param most_twist_deg  about the shaft
  Pose randomPose(double most_twist_deg = 180) {
    return {randomVector(0.05), rotationFromDegrees({random(30), random(30), random(most_twist_deg)})};
  }
  Pose moved(const Pose& pose, const Vector3d& by_m) const { return {pose.position_m + by_m, pose.orientation}; }

  const StylusConfig stylus_;
  const Trocar trocar_;
  std::mt19937 source_{7};
};
INSTANTIATE_TEST_SUITE_P(Follows, TrocarTest, ::testing::Values("handle", "tip"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(TrocarTest, ShaftPassesThePointAtAnyPose) {
  for (int i = 0; i < 1000; ++i) EXPECT_LT(missOf(trocar_.toolPose(randomPose())), 1e-12);
  EXPECT_LT(missOf(trocar_.toolPose({{0.2, 0.3, 0.9}, Quaterniond::Identity()})), 1e-12);  // pulled out
}

TEST_P(TrocarTest, PoseThatPassesThePointStays) {
  for (int i = 0; i < 100; ++i) {
    const Pose tool = trocar_.toolPose(randomPose()), again = trocar_.toolPose(tool);
    EXPECT_LT((again.position_m - tool.position_m).norm(), 1e-12);
    EXPECT_LT(again.orientation.angularDistance(tool.orientation), 1e-7);
  }
}

TEST_P(TrocarTest, TwistStays) {
  const Pose device{{0, 0, 0}, Quaterniond::Identity()};
  const Pose tool = trocar_.toolPose(device);
  for (const double turn : {0.3, 1.0, 3.0}) {
    const Quaterniond twist(Eigen::AngleAxisd(turn, Vector3d::UnitZ()));
    const Pose twisted = trocar_.toolPose({device.position_m, device.orientation * twist});
    EXPECT_LT(twisted.orientation.angularDistance(tool.orientation * twist), 1e-7);
    EXPECT_LT((twisted.position_m - tool.position_m).norm(), 1e-12);
  }
}

/// Poses jump, except for the twist, which devices do not turn by much in a tick.
TEST_P(TrocarTest, ShaftPassesThePointWithinTicksAndWhereTheTipIsSpeedLimited) {
  constexpr double kTravel_m = 0.004, kTwist_deg = 5;
  Tools tools({stylus_}, {kTravel_m});
  StylusSamples samples;
  samples[0].valid = true;
  int limited = 0;
  for (int t = 0; t < 200; ++t) {
    samples[0].pose = t % 20 == 0 ? randomPose(kTwist_deg) : moved(samples[0].pose, randomVector(0.002));
    const StylusMotion motion = tools.advance(samples)[0];
    limited += motion.speed_limited;
    if (t == 0) continue;
    for (const double share : {0.0, 0.5, 1.0}) {
      const Pose within{motion.from.position_m + share * (motion.to.position_m - motion.from.position_m),
                        motion.from.orientation.slerp(share, motion.to.orientation)};
      EXPECT_LT(missOf(within), share == 0.5 ? kPassesBetween_m : kPasses_m) << "tick " << t;
    }
  }
  EXPECT_GT(limited, 5);
}

/// The device's force does the work of the force and the torque at the tip, for any motion of the device.
TEST_P(TrocarTest, DeviceAndToolDoTheSameWork) {
  constexpr double kStep_m = 1e-6;
  for (int i = 0; i < 200; ++i) {
    const Pose device = trocar_.toolPose(randomPose());  // shafts of device and tool are parallel
    const Reaction tool{randomVector(1), randomVector(0.05), false};
    const Vector3d force_n = trocar_.deviceReaction(tool, device).force_n;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d step_m = kStep_m * Vector3d::Unit(axis);
      const Pose from = trocar_.toolPose(moved(device, -step_m)), to = trocar_.toolPose(moved(device, step_m));
      const Eigen::AngleAxisd turn(to.orientation * from.orientation.conjugate());
      const double work_j =
          tool.force_n.dot(to.position_m - from.position_m) + tool.torque_nm.dot(turn.angle() * turn.axis());
      EXPECT_NEAR(2 * kStep_m * force_n[axis], work_j, kSameWork * 2 * kStep_m * (1 + force_n.norm()));
    }
  }
}

TEST(TrocarLever, ForceAcrossTheShaftIsReversedAndScaledByTheLeverAndTheOtherStays) {
  const Trocar trocar(stylusWith("handle"));
  const Pose device{kPoint_m - Vector3d(0, 0, 0.1), Quaterniond::Identity()};  // 10 cm within, 20 cm outside
  const Reaction felt = trocar.deviceReaction({{1, 0, 2}, {0, 0, 0.03}, false}, device);
  EXPECT_NEAR(felt.force_n.x(), -0.5, 1e-12);
  EXPECT_NEAR(felt.force_n.z(), 2, 1e-12);
  EXPECT_NEAR(felt.torque_nm.z(), 0.03, 1e-12);
  EXPECT_NEAR(felt.torque_nm.y(), kShaft_m * felt.force_n.x(), 1e-12);
  const Pose tool = trocar.toolPose({device.position_m + Vector3d(0.002, 0, 0), device.orientation});
  EXPECT_NEAR(tool.position_m.x() - device.position_m.x(), -0.001, 1e-5);
  const Pose deeper = trocar.toolPose({device.position_m - Vector3d(0, 0, 0.01), device.orientation});
  EXPECT_LT((deeper.position_m - device.position_m + Vector3d(0, 0, 0.01)).norm(), 1e-12);
}

TEST(TrocarLever, StylusWithoutATrocarKeepsPosesAndForces) {
  const Trocar trocar(stylusWith("none"));
  const Pose pose{{1, 2, 3}, rotationFromDegrees({10, 20, 30})};
  EXPECT_EQ(trocar.toolPose(pose).position_m, pose.position_m);
  EXPECT_EQ(trocar.toolPose(pose).orientation.coeffs(), pose.orientation.coeffs());
  EXPECT_EQ(trocar.deviceReaction({{1, 2, 3}, {4, 5, 6}, false}, pose).force_n, Vector3d(1, 2, 3));
}

}  // namespace
}  // namespace viscera
