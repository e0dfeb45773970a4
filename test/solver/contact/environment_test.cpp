// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact/environment.h"
#include "viscera/model/scene/scene.h"

#include <gtest/gtest.h>

namespace viscera {
namespace {

constexpr double kTick_s = 0.1;
constexpr int kSubsteps = 2;

/// Environment with motions from Obstacles, as in a session.
class TickByTick : public ::testing::Test {
 protected:
  explicit TickByTick(const std::vector<ObstacleConfig>& configs = {ObstacleConfig{}})
      : obstacles_(configs), environment_(Model{}, sceneWith(configs)) {}

  /// @return whether the obstacles' motions changed in this tick's substeps
  bool moves(int substeps = kSubsteps) {
    obstacles_.advance(tick_ * kTick_s, kTick_s);
    ++tick_;
    environment_.beginTick(kTick_s, substeps, obstacles_.motions());
    return environment_.obstaclesMoved();
  }
  bool standsStill() {
    environment_.beginTick(kTick_s, kSubsteps, {});
    return !environment_.obstaclesMoved();
  }

  Obstacles obstacles_;
  Environment environment_;
  int tick_ = 0;

 private:
  static Scene sceneWith(const std::vector<ObstacleConfig>& configs) {
    Scene scene;
    scene.obstacles = configs;
    return scene;
  }
};

TEST_F(TickByTick, SubstepsUpdateOnlyObstaclesThatMove) {
  EXPECT_TRUE(moves());
  EXPECT_FALSE(moves());
  EXPECT_TRUE(moves(kSubsteps + 1));
  EXPECT_TRUE(moves());
  obstacles_.setFrame(0, {Vector3d(0, 0, 1), Quaterniond::Identity()});
  EXPECT_TRUE(moves());
  EXPECT_FALSE(moves());
  environment_.reset();
  EXPECT_TRUE(moves());
}

TEST_F(TickByTick, ObstaclesWithoutUpdatesStandStill) {
  EXPECT_FALSE(standsStill());  // the first tick
  EXPECT_TRUE(standsStill());
  moves();
  obstacles_.setFrame(0, {Vector3d(0, 0, 1), Quaterniond::Identity()});
  moves();
  EXPECT_EQ(environment_.at(0).obstacles[0].to.z, 1);
  standsStill();
  EXPECT_EQ(environment_.at(0).obstacles[0].from.z, 1);
  EXPECT_EQ(environment_.at(1).obstacles[0].to.z, 1);
}

struct MovingTickByTick : TickByTick {
  static std::vector<ObstacleConfig> moving() {
    std::vector<ObstacleConfig> out(2);
    out[1].velocity_m_per_s = Vector3d(1, 0, 0);
    return out;
  }
  MovingTickByTick() : TickByTick(moving()) {}
};

TEST_F(MovingTickByTick, EveryTickUpdatesAMovingObstacle) {
  for (int t = 0; t < 3; ++t) EXPECT_TRUE(moves()) << t;
  EXPECT_NEAR(environment_.at(1).obstacles[1].to.x, 0.3, 1e-6);
  EXPECT_NEAR(environment_.at(1).obstacles[1].velocity.x, 1, 1e-6);
  standsStill();
  EXPECT_EQ(environment_.at(0).obstacles[1].velocity.x, 0);
  EXPECT_NEAR(environment_.at(0).obstacles[1].from.x, 0.3, 1e-6);
}

}  // namespace
}  // namespace viscera
