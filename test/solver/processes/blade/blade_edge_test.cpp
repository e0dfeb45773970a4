// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Styluses with blades in tissue that resists them; forces and work are measured in test/bench and by `viscera bench
// blade`.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <random>
#include <string>

#include "math/archive.h"
#include "math/decompositions.h"
#include "model/fracture/toughness.h"
#include "model/scene/feature_rules.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/processes/blade/blades.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr double kBack_j = 1e-12;  // to the user, in a stroke: rounding of sums

/// A block on a plate, and a blade in it.
class Tool {
 public:
  explicit Tool(double toughness_j_per_m2) : scene_(sceneOf(toughness_j_per_m2)), model_(buildModel(scene_)) {
    solver_ = std::make_unique<CpuSolver>(model_, scene_);
  }
  static Scene sceneOf(double toughness_j_per_m2) {
    Scene scene;
    BodyConfig body;
    body.source = TissueSource::kBox;
    body.box_size_m = {0.04, 0.04, 0.02};
    body.spacing_m = 0.004;
    body.material.cut.toughness_j_per_m2 = toughness_j_per_m2;
    FixedConfig plate;
    plate.min_m = {-1, -1, -1};
    plate.max_m = {1, 1, -0.0099};
    body.fixed.push_back(plate);
    scene.bodies.push_back(body);
    StylusConfig stylus;
    stylus.idle = ToolMode::kCut;
    scene.styluses.push_back(stylus);
    scene.solver.backend = Backend::kCpu;
    scene.environment.gravity_m_per_s2.setZero();
    return scene;
  }
  /// Moves the blade over a tick. @returns the force on the tissue
  Vector3d to(const Pose& pose) {
    ToolMotions motions;
    motions[0].mode = ToolMode::kCut;
    motions[0].present = true;
    motions[0].from = at_;
    motions[0].to = at_ = pose;
    solver_->step(motions);
    while (solver_->pollStats(stats_, true)) bad_ += stats_.nonfinite;
    return Vector3d(stats_.impulse[0].x, stats_.impulse[0].y, stats_.impulse[0].z) * scene_.solver.tick_hz;
  }
  Vector3d to(const Vector3d& tip_m) { return to(Pose{tip_m, Quaterniond::Identity()}); }
  void appear(const Pose& pose) {
    solver_->step(ToolMotions{});
    at_ = pose;
  }
  void appearAt(const Vector3d& tip_m) { at_ = {tip_m, Quaterniond::Identity()}; }
  CpuSolver& solver() { return *solver_; }
  uint64_t bad() const { return bad_; }
  uint64_t hash() const { return stateHash(model_, solver_->readState()); }

 private:
  Scene scene_;
  Model model_;
  std::unique_ptr<CpuSolver> solver_;
  Pose at_{{-0.03, 0.001, 0.002}, Quaterniond::Identity()};
  layout::TickStats stats_{};
  uint64_t bad_ = 0;
};

constexpr double kStep_m = 0.001;  // per tick

TEST(BladeEdge, FeelsNothingInItsOwnWoundAndIsNeverPulled) {
  Tool tool(50);
  double x = -0.03, most = 0;
  for (; x < 0.006; x += kStep_m) most = std::max(most, tool.to({x, 0.001, 0.002}).x());
  EXPECT_GT(most, 0.2);
  for (; x > -0.012; x -= kStep_m) EXPECT_GE(tool.to({x, 0.001, 0.002}).x(), -1e-9);
  const double area_m2 = bladeWork(tool.solver(), 0).area_m2;
  for (; x < -0.002; x += kStep_m) EXPECT_LT(tool.to({x, 0.001, 0.002}).norm(), 0.02 * most);
  EXPECT_NEAR(bladeWork(tool.solver(), 0).area_m2, area_m2, 0.02 * area_m2);
}

TEST(BladeEdge, RandomStrokesStayFiniteAndGiveNothing) {
  Tool tool(200);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int stroke = 0; stroke < 60; ++stroke) {
    Pose pose{{0.03 * any(random), 0.03 * any(random), 0.012 * any(random)}, Quaterniond::Identity()};
    const Vector3d axis(any(random), any(random), 1.2 * any(random)),
        offset(any(random), any(random), 0.5 * any(random));
    pose.orientation = rotationBetween(Vector3d::UnitZ(), axis.normalized());
    if (stroke % 20 == 19) tool.solver().reset();
    const double before_j = bladeWork(tool.solver(), 0).work_j;
    tool.appear(pose);
    for (int tick = 0; tick < 10; ++tick) {
      pose.position_m += (tick < 7 ? 1 : -1) / 60.0 * offset;
      tool.to(pose);
    }
    if (stroke % 20 == 19) continue;
    EXPECT_GT(bladeWork(tool.solver(), 0).work_j - before_j, -kBack_j);
  }
  EXPECT_EQ(tool.bad(), 0u);
  EXPECT_EQ(tool.solver().health().trips, 0u);
}

TEST(BladeEdge, SavedFrontsGoOnToTheBit) {
  Tool first(100), second(100);
  for (int i = 0; i < 25; ++i) first.to({-0.03 + kStep_m * i, 0.001, 0.002});
  for (int i = 0; i < 3; ++i) second.to({-0.03 + kStep_m * i, 0.001, 0.002});
  Archive saved;
  first.solver().persist(saved);
  Archive read(saved.sections());
  second.solver().persist(read);
  second.appearAt({-0.03 + kStep_m * 24, 0.001, 0.002});
  for (int i = 25; i < 35; ++i) {
    first.to({-0.03 + kStep_m * i, 0.001, 0.002});
    second.to({-0.03 + kStep_m * i, 0.001, 0.002});
  }
  EXPECT_EQ(first.hash(), second.hash());
  EXPECT_EQ(bladeWork(first.solver(), 0).work_j, bladeWork(second.solver(), 0).work_j);
}

TEST(BladeEdge, WithoutToughnessBladesAreAsTheyWere) {
  Scene scene = Tool::sceneOf(0);
  EXPECT_FALSE(resistsBlades(scene));
  Tool tool(0);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(tool.to({-0.03 + kStep_m * i, 0.001, 0.002}).norm(), 0);
  EXPECT_EQ(bladeWork(tool.solver(), 0).area_m2, 0);
}

TEST(BladeEdge, WhatItDoesNotGoWithIsRefused) {
  const auto refused = [](const std::function<void(Scene&)>& change) {
    Scene scene = Tool::sceneOf(100);
    change(scene);
    try {
      requireFeatures(scene);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused([](Scene&) {}), "");
  EXPECT_NE(refused([](Scene& s) { s.solver.integrator = Integrator::kPd; }).find("solver.integrator leapfrog"),
            std::string::npos);
  EXPECT_EQ(refused([](Scene& s) { s.solver.backend = Backend::kGpu; }), "");
}

}  // namespace
}  // namespace viscera
