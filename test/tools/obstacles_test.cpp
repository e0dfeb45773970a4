// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/obstacles.h"
#include "viscera/layout/limits.h"

#include <gtest/gtest.h>

using namespace viscera;

namespace {

constexpr double kExact = 1e-12;  // m, float64
constexpr double kFloat = 1e-6;   // m/s and rad/s, float32

std::vector<layout::ObstacleMotion> cut(const ObstacleConfig& config, const Obstacles& obstacles, int substeps,
                                        double tick_s) {
  std::vector<layout::ObstacleMotion> out;
  interpolateObstacles({config}, obstacles.motions(), substeps, tick_s, out);
  return out;
}

}  // namespace

TEST(Obstacles, MoveAndTurnByTheirKeysFromTheStartOn) {
  ObstacleConfig config;
  config.position_m = Vector3d(1, 0, 0);
  config.velocity_m_per_s = Vector3d(0, 2, 0);
  config.rotation_deg_per_s = Vector3d(0, 0, 90);
  Obstacles obstacles({config});
  obstacles.advance(0, 0.5);
  obstacles.advance(0.5, 0.5);
  EXPECT_LT((obstacles.pose(0).position_m - Vector3d(1, 2, 0)).norm(), kExact);
  EXPECT_LT((obstacles.pose(0).orientation * Vector3d::UnitX() - Vector3d::UnitY()).norm(), kExact);
  const auto motions = cut(config, obstacles, 2, 0.5);
  EXPECT_NEAR(motions[0].velocity.y, 2, kFloat);
  EXPECT_NEAR(motions[0].spin.z, M_PI / 2, kFloat);
  EXPECT_NEAR(motions[0].to.y, 1.5, kFloat);
  EXPECT_EQ(motions[layout::kMaxObstacles].from.y, motions[0].to.y);
}

TEST(Obstacles, AFrameCarriesThemAndItsFirstPoseIsNoMotion) {
  ObstacleConfig config;
  config.position_m = Vector3d(0, 0, 1);
  config.frame = "arm";
  Obstacles obstacles({config});
  obstacles.setFrame(0, {Vector3d(5, 0, 0), Quaterniond::Identity()});
  obstacles.advance(0, 0.1);
  EXPECT_EQ(obstacles.motions()[0].from.position_m, Vector3d(5, 0, 1));
  EXPECT_EQ(obstacles.motions()[0].to.position_m, Vector3d(5, 0, 1));
  const Quaterniond turned(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()));
  obstacles.setFrame(0, {Vector3d(6, 0, 0), turned});
  obstacles.advance(0.1, 0.1);
  EXPECT_EQ(obstacles.motions()[0].from.position_m, Vector3d(5, 0, 1));
  EXPECT_LT((obstacles.motions()[0].to.position_m - Vector3d(6, -1, 0)).norm(), kExact);
  EXPECT_NEAR(cut(config, obstacles, 1, 0.1)[0].spin.x, M_PI / 2 / 0.1, 1e-5);
  obstacles.advance(0.2, 0.1);  // no message of the frame: it stops
  EXPECT_EQ(obstacles.motions()[0].from.position_m, obstacles.motions()[0].to.position_m);
}

TEST(Obstacles, AfterAResetTheyAreWhereTheyWereAtTheStart) {
  ObstacleConfig config;
  config.velocity_m_per_s = Vector3d(1, 0, 0);
  Obstacles obstacles({config});
  obstacles.advance(0, 1);
  obstacles.reset();
  EXPECT_EQ(obstacles.pose(0).position_m, Vector3d::Zero());
}

TEST(Obstacles, AFrameThatJumpsIsFollowedNoFasterThanTissueCan) {
  constexpr double kMost_m = 0.01, kTick_s = 0.01;
  for (const bool turns : {false, true}) {
    ObstacleConfig config;
    config.shape = ObstacleShape::kBox;
    config.size_m = Vector3d(0.2, 0.02, 0.02);
    config.frame = "arm";
    Obstacles obstacles({config}, kMost_m);
    obstacles.setFrame(0, Pose{});
    obstacles.advance(0, kTick_s);
    EXPECT_FALSE(obstacles.speedLimited(0));
    const Pose far{Vector3d(turns ? 0 : 0.1, 0, 0),
                   turns ? Quaterniond(Eigen::AngleAxisd(1, Vector3d::UnitZ())) : Quaterniond::Identity()};
    obstacles.setFrame(0, far);
    int speed_limited = 0;
    const Vector3d corner = 0.5 * config.size_m;
    for (int t = 1; t <= 40; ++t) {
      obstacles.advance(t * kTick_s, kTick_s);
      const RigidMotion& motion = obstacles.motions()[0];
      EXPECT_LE((motion.to * corner - motion.from * corner).norm(), kMost_m + kExact) << t;
      speed_limited += obstacles.speedLimited(0);
    }
    EXPECT_GE(speed_limited, 9) << turns;  // ten ticks of 1 cm each make 10 cm
    EXPECT_FALSE(obstacles.speedLimited(0));
    EXPECT_LT((obstacles.pose(0).position_m - far.position_m).norm(), kExact);
    EXPECT_LT(obstacles.pose(0).orientation.angularDistance(far.orientation), 1e-7);  // acos of nearly 1
  }
}

TEST(Obstacles, ThatMoveByTheirKeysAreNotHeldBack) {
  ObstacleConfig config;
  config.velocity_m_per_s = Vector3d(10, 0, 0);
  Obstacles obstacles({config}, 0.01);
  obstacles.advance(0, 0.1);
  EXPECT_FALSE(obstacles.speedLimited(0));
  EXPECT_LT((obstacles.pose(0).position_m - Vector3d(1, 0, 0)).norm(), kExact);
}
