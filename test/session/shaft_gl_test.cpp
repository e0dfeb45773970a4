// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Shafts that tissue meets (physics.md 5), by the key `styluses[].shaft_contact`.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "session/on_backends.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kRadius_m = 0.006, kDepth_m = 0.003, kHalfPad_m = 0.032, kTop_m = 0.016;
constexpr double kLever_m = 0.06;          ///< from the tip to the middle of the pad
constexpr int kPressing = 15, kHeld = 25;  // ticks; at rest after these
constexpr int kFelt = 2;                   // ticks until a force is certainly felt

/// A pad on a rigid base, its middle at the origin, and a stylus without a tip.
const std::string kPad = R"(
environment: {gravity_m_per_s2: [0, 0, 0]}
solver: {threads: 1}
bodies:
  - source: box
    box_size_m: [0.064, 0.064, 0.016]
    position_m: [0, 0, 0.008]
    spacing_m: 0.004
    material: {young_modulus_pa: 10000, mass_damping_per_s: 20}
    fixed: [{shape: plane, point_m: [0, 0, 0.0001]}]
styluses:
  - {idle: none, button1: grab, button2: cut, shaft_length_m: 0.12, shaft_radius_m: 0.006, shaft_contact: true,
     max_force_n: 1000, max_force_rate_n_per_s: 1.0e+6, max_torque_nm: 100, max_torque_rate_nm_per_s: 1.0e+5}
)";

/// Returns the orientation of a shaft that is laid down, its back at an angle to x.
Quaterniond laid(double yaw_deg) {
  return Eigen::AngleAxisd(yaw_deg * M_PI / 180, Vector3d::UnitZ()) * Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY());
}

/// Returns the stylus with its shaft over the middle of the pad. @param below_m  depth of its surface in the pad
StylusSamples over(double yaw_deg, double below_m, double lever_m = kLever_m) {
  StylusSamples out;
  const Quaterniond turn = laid(yaw_deg);
  out[0].valid = true;
  out[0].pose = {Vector3d(0, 0, kTop_m + kRadius_m - below_m) - turn * Vector3d(0, 0, lever_m), turn};
  return out;
}
double depthAt(int tick) {
  return kDepth_m * std::min(1.0, 2.0 * tick / kPressing - 1);
}

class Shafts : public OnSceneBackend {
 protected:
  static Scene pad(std::vector<std::string> overrides = {}) {
    overrides.push_back(std::string("solver.backend=") + (GetParam() == Backend::kCpu ? "cpu" : "gpu"));
    return parseScene(kPad, "pad.yaml", overrides);
  }
  /// Lays the shaft on the pad. @param change  buttons, for example   @param held  ticks that it stays there
  template <class Change>
  static Frame lay(Session& session, double yaw_deg, double lever_m, const Change& change, int held = kFelt) {
    Frame frame;
    for (int tick = 0; tick < kPressing + held; ++tick) {
      StylusSamples samples = over(yaw_deg, depthAt(tick), lever_m);
      change(samples[0]);
      frame = session.step(samples, {});
    }
    session.drain();
    return frame;
  }
  static Frame lay(Session& session, double yaw_deg, int held = kFelt) {
    return lay(
        session, yaw_deg, kLever_m, [](StylusSample&) {}, held);
  }
};

/// By symmetry the pad's pressure has its centre in the middle of the pad. 60 degrees are 30 for the lattice.
TEST_P(Shafts, LaidOnAPadAreFeltWithTheirLever) {
  constexpr double kLever = 0.02, kAcross = 0.02;   // relative
  const bool on_gpu = GetParam() == Backend::kGpu;  // in software a tick takes ten times as long
  for (const double yaw_deg : on_gpu ? std::vector{30.0} : std::vector{0.0, 30.0, 60.0}) {
    SCOPED_TRACE(yaw_deg);
    Session session(pad(), context_);
    const Reaction felt = lay(session, yaw_deg, kHeld).reactions[0];
    EXPECT_GT(felt.force_n.z(), 0.5);
    EXPECT_LT(felt.force_n.head<2>().norm(), kAcross * felt.force_n.z());
    const Vector3d arm = laid(yaw_deg) * Vector3d(0, 0, kLever_m);
    const Vector3d moment = arm.cross(felt.force_n);
    EXPECT_LT((felt.torque_nm - moment).norm(), kLever * moment.norm()) << felt.torque_nm.transpose();
  }
}

/// Rows of nodes are 4 mm apart, and the shaft is 2 mm thick, between two rows.
TEST_P(Shafts, DoNotPassBetweenNodes) {
  Scene scene = pad({"styluses[0].shaft_radius_m=0.001"});
  Session session(scene, context_);
  StylusSamples samples = over(0, 0);
  samples[0].pose.position_m.y() = 0.002;
  Frame frame;
  for (int tick = 0; tick < kPressing + kFelt; ++tick) {
    samples[0].pose.position_m.z() = kTop_m + 0.001 - depthAt(tick);
    frame = session.step(samples, {});
  }
  EXPECT_GT(frame.reactions[0].force_n.z(), 2) << "0.08 N once it has slipped through";
}

TEST_P(Shafts, ArePassedByTissueWithoutTheKey) {
  Session session(pad({"styluses[0].shaft_contact=false"}), context_);
  const uint64_t before = session.stateHash();
  EXPECT_EQ(lay(session, 0).reactions[0].force_n.norm(), 0);
  EXPECT_EQ(session.stateHash(), before);
}

/// A blade on the side of the shaft covers the pad; behind a shorter one the shaft does.
TEST_P(Shafts, DoNotPushWithTheirBladeAndDoBehindIt) {
  {
    Session session(pad({"styluses[0].cut.blade_length_m=0.1"}), context_);
    const Frame bare = lay(session, 0, 0.04, [](StylusSample& sample) {
      sample.button2 = true;
      sample.pose.position_m.z() -= kRadius_m;  // the blade is on the axis
    });
    EXPECT_EQ(bare.reactions[0].force_n.norm(), 0);
    EXPECT_GT(bare.stats.springs_cut, 0u);
  }
  Session session(pad({"styluses[0].cut.blade_length_m=0.01"}), context_);
  const Frame pressed = lay(session, 0, kLever_m, [](StylusSample& sample) { sample.button2 = true; });
  EXPECT_GT(pressed.reactions[0].force_n.z(), 0.5);
  EXPECT_EQ(pressed.stats.springs_cut, 0u);
}

TEST_P(Shafts, OfGripsPushToo) {
  Session session(pad(), context_);
  const Frame pressed = lay(session, 0, kLever_m, [](StylusSample& sample) { sample.button1 = true; });
  EXPECT_GT(pressed.reactions[0].force_n.z(), 0.5);
  EXPECT_EQ(pressed.stats.grabbed[0], 0u);
}

TEST_P(Shafts, ThatAppearInTissuePushOnceTheyHaveBeenOutside) {
  Session session(pad(), context_);
  Frame frame;
  for (int tick = 0; tick < 5; ++tick) frame = session.step(over(0, kDepth_m), {});
  EXPECT_TRUE(frame.inside[0]);
  EXPECT_EQ(frame.reactions[0].force_n.norm(), 0);
  for (int tick = 0; tick < 5; ++tick) frame = session.step(over(0, -0.02), {});
  EXPECT_FALSE(frame.inside[0]);
  EXPECT_GT(lay(session, 0).reactions[0].force_n.z(), 0.5);
}

VISCERA_ON_EVERY_BACKEND(Shafts);

/// An obstacle is another implementation of contact, with nodes alone. Cells are a third of the radius: at 4 mm the
/// shaft is a third stiffer, as its springs cannot follow it, and the capsule a third softer.
TEST(ShaftContact, IsAsStiffAsACapsuleAndAlikeAtAllAngles) {
  constexpr double kForce = 0.1, kAngles = 0.05;  // relative
  constexpr int kSettled = 8;                     // ticks: with so much drag it rests by then
  const std::vector<std::string> fine = {"solver.backend=cpu", "bodies[0].spacing_m=0.002",
                                         "bodies[0].material.mass_damping_per_s=60"};
  double straight_n_per_m = 0;
  for (const double yaw_deg : {0.0, 30.0}) {  // 60 is 30 for the lattice
    SCOPED_TRACE(yaw_deg);
    Session session(parseScene(kPad, "pad.yaml", fine));
    Scene scene = parseScene(kPad, "pad.yaml", fine);
    scene.styluses.clear();
    scene.obstacles.resize(1);
    scene.obstacles[0].shape = ObstacleShape::kCapsule;
    scene.obstacles[0].radius_m = kRadius_m;
    scene.obstacles[0].length_m = 0.12;
    scene.obstacles[0].friction = 0;
    scene.obstacles[0].frame = "rod";
    Session capsule(scene);
    Frame shaft_frame, capsule_frame;
    for (int tick = kPressing / 2; tick < kPressing + kSettled; ++tick) {
      shaft_frame = session.step(over(yaw_deg, depthAt(tick)), {});
      capsule.setObstacleFrame(0, {Vector3d(0, 0, kTop_m + kRadius_m - depthAt(tick)), laid(yaw_deg)});
      capsule_frame = capsule.step({}, {});
    }
    const double felt_n = shaft_frame.reactions[0].force_n.z();
    EXPECT_NEAR(felt_n, capsule_frame.obstacle_forces.at(0).force_n.z(), kForce * felt_n);
    const double across_deg = std::min(yaw_deg, 90 - yaw_deg);
    const double per_length = felt_n / (2 * kHalfPad_m / std::cos(across_deg * M_PI / 180));
    if (yaw_deg == 0) straight_n_per_m = per_length;
    EXPECT_NEAR(per_length, straight_n_per_m, kAngles * straight_n_per_m);
  }
}

/// Two crossed shafts; the second goes down on the first, and past its axis.
TEST(ShaftContact, BetweenShaftsPushesBothApart) {
  constexpr double kStiffness_n_per_m = 500, kRounding = 1e-6;
  Scene scene = parseScene(kPad, "pad.yaml", {"solver.backend=cpu"});
  scene.styluses.push_back(scene.styluses[0]);
  scene.styluses[1].name = "other";
  Session session(scene);
  Frame frame;
  const auto cross = [&](double above_m) {
    StylusSamples samples;
    for (size_t s = 0; s < 2; ++s) {
      const Quaterniond turn = laid(s == 0 ? 0 : 90);
      samples[s].valid = true;
      samples[s].pose = {Vector3d(0, 0, 0.1 + (s == 1 ? above_m : 0)) - turn * Vector3d(0, 0, kLever_m), turn};
    }
    return session.step(samples, {});
  };
  EXPECT_FALSE(cross(0.02).shafts_touch);
  EXPECT_FALSE(cross(0.0125).shafts_touch);
  for (const double above_m : {0.008, 0.002, -0.004}) {
    frame = cross(above_m);
    EXPECT_TRUE(frame.shafts_touch);
    const double force_n = kStiffness_n_per_m * (2 * kRadius_m - above_m);
    const Vector3d arm = laid(90) * Vector3d(0, 0, kLever_m), push(0, 0, force_n);
    EXPECT_LT((frame.reactions[1].force_n - push).norm(), kRounding * force_n);
    EXPECT_LT((frame.reactions[0].force_n + push).norm(), kRounding * force_n);
    EXPECT_LT((frame.reactions[1].torque_nm - arm.cross(push)).norm(), kRounding * force_n);
    EXPECT_EQ(frame.contacts[0].kind, TickContact::Kind::kPushes);
  }
  EXPECT_FALSE(cross(0.02).shafts_touch);
  EXPECT_EQ(cross(0.02).reactions[0].force_n.norm(), 0);
}

TEST(ShaftContact, OfBothBackendsIsFeltAlike) {
  constexpr double kAlike = 1e-3;  // relative: single precision over a second of ticks
  gpu::Context context;
  std::vector<double> felt_n;
  for (const char* backend : {"solver.backend=cpu", "solver.backend=gpu"}) {
    Session session(parseScene(kPad, "pad.yaml", {backend}), context);
    Frame frame;
    for (int tick = 0; tick < kPressing; ++tick) {
      StylusSamples samples;
      samples[0].valid = true;
      samples[0].pose = {Vector3d(-kLever_m, 0, kTop_m + kRadius_m + 0.002 - 0.0003 * tick), laid(0)};
      frame = session.step(samples, {});
    }
    felt_n.push_back(frame.reactions[0].force_n.z());
  }
  EXPECT_NEAR(felt_n[0], felt_n[1], kAlike * felt_n[0]);
}

}  // namespace
}  // namespace viscera
