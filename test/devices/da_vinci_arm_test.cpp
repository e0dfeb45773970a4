// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/da_vinci_arm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "devices/arm_motion.h"
#include "devices/device_map.h"
#include "support/source_folder.h"

namespace viscera {
namespace {

constexpr double kArmRounding = 1e-9;    // m, rad: a chain of seven rotations and their inverse
constexpr double kTableRounding = 1e-6;  // deg
constexpr double kDeg = M_PI / 180;

using Joints = DaVinciArm::Joints;

/// Returns a transform by modified Denavit-Hartenberg parameters (Craig), the independent form of the chain.
Eigen::Isometry3d link(double alpha, double a, double d, double theta) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.rotate(Eigen::AngleAxisd(alpha, Vector3d::UnitX()));
  out.translate(Vector3d(a, 0, 0));
  out.rotate(Eigen::AngleAxisd(theta, Vector3d::UnitZ()));
  out.translate(Vector3d(0, 0, d));
  return out;
}

/// Returns the frames of a classic PSM with a Large Needle Driver: the end of the shaft, and the tip.
std::pair<Eigen::Isometry3d, Eigen::Isometry3d> psmByTable(const Joints& q) {
  const double h = M_PI / 2;
  const Eigen::Isometry3d shaft =
      link(h, 0, 0, q[0] + h) * link(-h, 0, 0, q[1] - h) * link(h, 0, q[2] - 0.4318, 0) * link(0, 0, 0.4162, q[3]);
  Eigen::Isometry3d tooltip = Eigen::Isometry3d::Identity();
  tooltip.linear() << 0, -1, 0, 0, 0, 1, -1, 0, 0;
  tooltip.translation() = Vector3d(0, 0.0102, 0);
  return {shaft, shaft * link(-h, 0, 0, q[4] - h) * link(-h, 0.0091, 0, q[5] - h) * tooltip};
}

Joints drawn(std::mt19937& dice, bool has_wrist) {
  const auto within = [&](double most) { return std::uniform_real_distribution<double>(-most, most)(dice); };
  const double slide_m = has_wrist ? std::uniform_real_distribution<double>(0.0166, 0.24)(dice)
                                   : std::uniform_real_distribution<double>(0, 0.254)(dice);
  Joints q = {within(1.5), within(0.75), slide_m, within(has_wrist ? 4.5 : 1.5)};
  if (has_wrist) q.insert(q.end(), {within(1.39), within(1.39)});
  return q;
}

double largestDifference(const Joints& a, const Joints& b) {
  double out = a.size() == b.size() ? 0 : INFINITY;
  for (size_t i = 0; i < a.size() && i < b.size(); ++i) out = std::max(out, std::abs(a[i] - b[i]));
  return out;
}

TEST(DaVinciArm, TipAgreesWithTheTableOfItsLinks) {
  const DaVinciArm psm(ArmJoints::kPsm);
  std::mt19937 dice(4);
  for (int i = 0; i < 100; ++i) {
    const Joints q = drawn(dice, true);
    const auto [shaft, tip] = psmByTable(q);
    const Pose pose = psm.tip(q);
    EXPECT_LT((pose.position_m - tip.translation()).norm(), kArmRounding);
    EXPECT_LT((pose.orientation.toRotationMatrix() - tip.linear()).norm(), kArmRounding);
    // The remote centre: the shaft passes the origin of the base, whatever the joints are.
    EXPECT_LT(shaft.translation().cross(shaft.linear().col(2)).norm(), kArmRounding);
  }
}

TEST(DaVinciArm, JointsOfZeroPointDown) {
  const Pose psm = DaVinciArm(ArmJoints::kPsm).tip({0, 0, 0.1, 0, 0, 0});
  EXPECT_LT((psm.position_m - Vector3d(0, 0, -(0.1 - 0.4318 + 0.4162 + 0.0091 + 0.0102))).norm(), kArmRounding);
  EXPECT_LT((psm.orientation * Vector3d::UnitZ() + Vector3d::UnitZ()).norm(), kArmRounding);
  EXPECT_LT((psm.orientation * Vector3d::UnitX() - Vector3d::UnitY()).norm(), kArmRounding);
  const Pose ecm = DaVinciArm(ArmJoints::kEcm).tip({M_PI / 2, 0, 0.1, 0});
  EXPECT_LT((ecm.position_m - Vector3d(0.1 - 0.3822 + 0.385495, 0, 0)).norm(), kArmRounding);
}

TEST(DaVinciArm, ReachesEveryPoseOfItsJointsByTheseJoints) {
  for (const ArmJoints kind : {ArmJoints::kPsm, ArmJoints::kEcm}) {
    const DaVinciArm arm(kind);
    std::mt19937 dice(5);
    for (int i = 0; i < 300; ++i) {
      const Joints q = drawn(dice, kind == ArmJoints::kPsm);
      ASSERT_TRUE(arm.isWithin(q));
      Joints near = q;
      near[3] += 1;  // the roll is continued from it
      const auto found = arm.reach(arm.tip(q), near);
      ASSERT_TRUE(found);
      EXPECT_LT(largestDifference(*found, q), kArmRounding);
    }
  }
}

TEST(DaVinciArm, RefusesWhatIsBeyondItsLimits) {
  const DaVinciArm arm(ArmJoints::kPsm);
  const Joints start = {0, 0, 0.1, 0, 0, 0};
  EXPECT_FALSE(arm.reach({{0, 0, 0.1}, arm.tip(start).orientation}, start));   // above the remote centre
  EXPECT_FALSE(arm.reach({{0, 0, -0.4}, arm.tip(start).orientation}, start));  // too deep
  EXPECT_FALSE(arm.reach({{0, 0, -0.1}, Quaterniond::Identity()}, start));     // jaws that point back
  EXPECT_FALSE(arm.reach({Vector3d::Constant(NAN), Quaterniond::Identity()}, start));
  EXPECT_FALSE(arm.isWithin({0, 0, 0.1, 0, 0}));
  EXPECT_FALSE(arm.isWithin({0, 0, 0.3, 0, 0, 0}));
  EXPECT_FALSE(arm.isWithin({0, 0, 0.0165, 0, 0, 0}));  // the end of the shaft at the remote centre, or behind it
  EXPECT_NE(arm.limitsText().find("insertion 0.0166 .. 0.24 m"), std::string::npos) << arm.limitsText();
  EXPECT_FALSE(arm.isWithin({0, NAN, 0.1, 0, 0, 0}));
  EXPECT_EQ(DaVinciArm(ArmJoints::kEcm).limitsText().substr(0, 44), "yaw -91.96 .. 91.96 deg, pitch -45 .. 66.4 d");
}

/// Turn of a tool, as a vector about the axes of the tissue frame [deg].
Vector3d turnOf(const Quaterniond& from, const Quaterniond& to) {
  const Eigen::AngleAxisd turn(to * from.conjugate());
  return turn.angle() / kDeg * turn.axis();
}

/// The rows of NVIDIA/IsaacTeleop pull request 769, in a straight base and in one that is turned by 180 degrees: a hand
/// that turns by +30 degrees about z turns the tool by +30 degrees about z, whichever way the tool is held.
TEST(DaVinciArm, ToolTurnsAsTheHandDoes) {
  const Quaterniond upright = Quaterniond::Identity(), down = rotationFromDegrees({180, 0, 0}),
                    aside = rotationFromDegrees({0, 60, 0}), turn = rotationFromDegrees({0, 0, 30});
  struct Row {
    Quaterniond home, offset;
  };
  for (const Row& row : {Row{upright, upright}, Row{down, upright}, Row{aside, upright}, Row{down, down.conjugate()}}) {
    for (const Quaterniond& base : {upright, down}) {
      DeviceProfile device;
      device.tip.orientation = row.home * row.offset;
      device.base = {true, Vector3d(0.1, 0, 0.2), base};
      const DeviceMap map(device);
      // The hand is turned in the tissue frame; the device measures it in the frame of its base.
      const auto toolOf = [&](const Quaterniond& hand) {
        return map.base()->orientation * map.tipOf({Vector3d::Zero(), base.conjugate() * hand}).tip.orientation;
      };
      EXPECT_LT((turnOf(toolOf(upright), toolOf(turn)) - Vector3d(0, 0, 30)).norm(), kTableRounding);
    }
  }
}

TEST(DaVinciArm, ShippedProfilesStartWithinReach) {
  for (const char* const name : {"dvrk_psm", "dvrk_ecm"}) {
    DeviceChoice choice;
    choice.stylus = "left";
    const std::string path = test::sourceFolder() + "/config/devices/" + name + ".yaml";
    EXPECT_NE(loadDevice(path, choice).arm.joints, ArmJoints::kNone);
    choice.overrides = {"arm.start_m=[0,0,0.1]"};
    try {
      loadDevice(path, choice);
      FAIL() << name;
    } catch (const DeviceError& error) {
      EXPECT_NE(std::string(error.what()).find("the arm cannot reach 'arm.start_m'"), std::string::npos);
    }
  }
}

TEST(DaVinciArm, MovesAlongItsJoints) {
  const DaVinciArm arm(ArmJoints::kPsm);
  ArmConfig config;
  config.turn_deg_per_s = 90;
  ArmMotion motion(config);
  const Joints from = {0, 0, 0.1, 0, 0, 0}, to = {M_PI / 4, 0, 0.1, 0, 0, 0};
  motion.servo(arm.tip(from));
  ASSERT_TRUE(motion.moveAlong([&](double share) { return arm.tip(between(from, to, share)); }, M_PI / 4, 0));
  EXPECT_LT((motion.goal().position_m - arm.tip(to).position_m).norm(), kArmRounding);
  motion.advance(15.0 / 8 * 0.5 / 2);  // half of the time: half of the way, on the circle about the remote centre
  EXPECT_LT((motion.setpoint().position_m - arm.tip(between(from, to, 0.5)).position_m).norm(), kArmRounding);
  motion.advance(1);
  EXPECT_FALSE(motion.busy());
  EXPECT_LT((motion.setpoint().position_m - arm.tip(to).position_m).norm(), kArmRounding);
}

}  // namespace
}  // namespace viscera
