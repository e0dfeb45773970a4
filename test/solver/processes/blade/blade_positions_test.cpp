// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Blades in bodies with a toughness that varies with position, and with friction.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "math/archive.h"
#include "math/decompositions.h"
#include "model/fracture/toughness.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/processes/blade/blades.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr double kSpeed_m_per_s = 0.1, kWidth_m = 0.012, kAcross_m = 0.02, kCapsule_m = 0.002;
constexpr double kForce = 0.05;  // of J w, as in other tests
constexpr double kBack = 0.1;    // of friction: on its return a blade cuts a little where tissue bulged beyond its end

Scene sceneOf(const BodyConfig& body, double blade_m) {
  Scene scene;
  scene.bodies.push_back(body);
  StylusConfig stylus;
  stylus.idle = ToolMode::kCut;
  stylus.cut.blade_length_m = blade_m;
  scene.styluses.push_back(stylus);
  scene.environment.gravity_m_per_s2.setZero();
  scene.solver.backend = Backend::kCpu;
  scene.solver.sleep_speed_m_per_s = 0;
  return scene;
}

BodyConfig blockOf(const Vector3d& size_m, double toughness_j_per_m2) {
  BodyConfig body;
  body.source = TissueSource::kBox;
  body.box_size_m = size_m;
  body.spacing_m = 0.004;
  body.material.cut.toughness_j_per_m2 = toughness_j_per_m2;
  return body;
}

void hold(BodyConfig& body, const Vector3d& side) {
  const Vector3d half = 0.5 * body.box_size_m, thin = Vector3d::Constant(0.49 * body.spacing_m), all = half + thin;
  FixedConfig fixed;
  fixed.min_m = (side.array() > 0).select(half - thin, -all);
  fixed.max_m = (side.array() < 0).select(-half + thin, all);
  body.fixed.push_back(fixed);
}

/// A stylus that moves at constant speed.
class BladePositionsTool {
 public:
  BladePositionsTool(const Model& model, const Scene& scene, const Pose& pose)
      : tick_s_(1 / scene.solver.tick_hz), solver_(model, scene), at_(pose) {}
  /// @returns the mean force along the path
  double go(const Vector3d& offset_m) {
    const Vector3d along = offset_m.normalized();
    const int ticks = std::max(1, static_cast<int>(offset_m.norm() / (kSpeed_m_per_s * tick_s_)));
    double sum = 0;
    for (int i = 0; i < ticks; ++i) {
      ToolMotions motions;
      motions[0].mode = ToolMode::kCut;
      motions[0].present = true;
      motions[0].from = at_;
      at_.position_m += offset_m / ticks;
      motions[0].to = at_;
      solver_.step(motions);
      layout::TickStats stats;
      while (solver_.pollStats(stats, true)) last_ = stats;
      const Vector3d impulse(last_.impulse[0].x, last_.impulse[0].y, last_.impulse[0].z);
      sum += impulse.dot(along) / tick_s_;
      most_n_ = std::max(most_n_, impulse.dot(along) / tick_s_);
    }
    return sum / ticks;
  }
  double most_n() const { return most_n_; }
  void put(const BladePositionsTool& other) { at_ = other.at_; }
  /// Places it elsewhere, as after a tick without a tool.
  void put(const Pose& pose) {
    solver_.step(ToolMotions{});
    at_ = pose;
  }
  CpuSolver& solver() { return solver_; }

 private:
  double tick_s_, most_n_ = 0;
  CpuSolver solver_;
  Pose at_;
  layout::TickStats last_{};
};

/// A block free above and below, with the blade through its whole thickness.
struct Cut {
  explicit Cut(double toughness_j_per_m2) : body(blockOf({0.08, 0.048, kWidth_m}, toughness_j_per_m2)) {
    for (const Vector3d& side : {Vector3d(0, 1, 0), Vector3d(0, -1, 0), Vector3d(1, 0, 0)}) hold(body, side);
    scene = sceneOf(body, kWidth_m + 0.006);
    model = buildModel(scene);
  }
  Pose before() const { return {{-0.041, 0.0003, -0.5 * kWidth_m - 0.003}, Quaterniond::Identity()}; }
  BodyConfig body;
  Scene scene;
  Model model;
};

/// Divides a body into two parts, a before b.
void divide(Body& body, double toughness_j_per_m2) {
  body.lattice.part_names = {"a", "b"};
  for (const uint32_t slot : body.lattice.active_slots) {
    uint16_t& label = body.lattice.cell_labels[slot];
    if (label > 0) label = body.lattice.restPosition(slot).x() < -1e-6 ? 1 : 2;
  }
  PartConfig part;
  part.part = "b";
  part.young_modulus_pa = body.material.young_modulus_pa;
  part.density_kg_per_m3 = body.material.density_kg_per_m3;
  part.cut.toughness_j_per_m2 = toughness_j_per_m2;
  body.parts.push_back(part);
}

TEST(BladePositions, EveryPartHasItsOwnToughness) {
  for (const double second : {50.0, 0.0}) {
    Cut cut(100);
    divide(cut.model.bodies[0], second);
    BladePositionsTool tool(cut.model, cut.scene, cut.before());
    tool.go({0.027, 0, 0});
    EXPECT_NEAR(tool.go({0.01, 0, 0}), 100 * kWidth_m, kForce * 100 * kWidth_m);
    tool.go({0.02, 0, 0});
    EXPECT_NEAR(tool.go({0.01, 0, 0}), second * kWidth_m, kForce * 50 * kWidth_m);
    const BladeWork work = bladeWork(tool.solver(), 0);
    EXPECT_EQ(tool.solver().health().trips, 0u);
    EXPECT_NEAR(work.parting_j, kWidth_m * (100 * 0.04 + second * (work.area_m2 / kWidth_m - 0.04)),
                0.02 * work.parting_j);
  }
}

TEST(BladePositions, ABodyOfWhichOnlyALayerOrAPartIsToughResists) {
  BodyConfig body = blockOf({0.02, 0.02, 0.02}, 0);
  EXPECT_FALSE(resistsBlades(sceneOf(body, 0.02)));
  body.layers = {{0.001, Vector3d::Ones(), 30}};
  EXPECT_TRUE(resistsBlades(sceneOf(body, 0.02)));
  body.layers.clear();
  body.parts = {PartConfig{}};
  EXPECT_FALSE(resistsBlades(sceneOf(body, 0.02)));
  body.parts[0].cut.toughness_j_per_m2 = 30;
  EXPECT_TRUE(resistsBlades(sceneOf(body, 0.02)));
  EXPECT_FALSE(cutsFreely(sceneOf(body, 0.02)));
}

/// A blade parallel to the surface is pressed through it. Its ends are in the capsule of the sides throughout.
TEST(BladePositions, ACapsuleGivesAPeakAndADrop) {
  const auto pressed = [](double capsule_j_per_m2, double& most_n) {
    BodyConfig body = blockOf({0.048, kAcross_m, 0.04}, 40);
    hold(body, {0, 0, -1});
    body.layers = {{kCapsule_m, Vector3d::Ones(), capsule_j_per_m2}};
    const Scene scene = sceneOf(body, kAcross_m + 0.006);
    const Quaterniond lies = rotationBetween(Vector3d::UnitZ(), Vector3d::UnitY());
    BladePositionsTool tool(buildModel(scene), scene, {{0.0003, -0.5 * kAcross_m - 0.003, 0.021}, lies});
    tool.go({0, 0, -0.02});
    most_n = tool.most_n();
    return tool.go({0, 0, -0.005});
  };
  double plain_n = 0, tough_n = 0;
  const double plain_after_n = pressed(0, plain_n), after_n = pressed(120, tough_n);
  const double ends_n = 2 * kCapsule_m * (120 - 40);
  EXPECT_GT(tough_n, 2 * plain_n);
  EXPECT_NEAR(after_n, plain_after_n + ends_n, kForce * after_n);
}

TEST(BladePositions, WallsRubInTheTissueAndInTheirOwnWound) {
  Cut cut(50);
  cut.scene.styluses[0].cut.friction_n_per_m = 20;
  BladePositionsTool tool(cut.model, cut.scene, cut.before());
  tool.go({0.04, 0, 0});
  EXPECT_NEAR(tool.go({0.01, 0, 0}), 70 * kWidth_m, kForce * 70 * kWidth_m);
  tool.go({-0.015, 0, 0});
  const double area_m2 = bladeWork(tool.solver(), 0).area_m2;
  EXPECT_NEAR(tool.go({-0.01, 0, 0}), 20 * kWidth_m, kBack * 20 * kWidth_m);
  EXPECT_NEAR(bladeWork(tool.solver(), 0).area_m2, area_m2, 0.01 * area_m2);
  EXPECT_EQ(tool.solver().health().trips, 0u);
}

/// A blade pushed into a block with a capsule from above.
struct Needle {
  Needle() : body(blockOf({0.048, 0.048, 0.04}, 80)) {
    hold(body, {0, 0, -1});
    body.layers = {{0.001, Vector3d::Ones(), 500}};
    scene = sceneOf(body, 0.06);
    scene.styluses[0].cut.point_width_m = kNeedle_m;
    scene.solver.tick_hz = 240;
    model = buildModel(scene);
  }
  static Pose above() { return {{0.0003, 0.0005, 0.021}, Quaterniond::Identity()}; }
  static constexpr double kNeedle_m = 0.002;
  BodyConfig body;
  Scene scene;
  Model model;
};

TEST(BladePositions, ANeedlePuncturesDropsAndGoesOnByItsWidth) {
  Needle needle;
  BladePositionsTool tool(needle.model, needle.scene, needle.above());
  tool.go({0, 0, -0.012});
  EXPECT_NEAR(tool.most_n(), 500 * Needle::kNeedle_m, kForce * 500 * Needle::kNeedle_m);
  tool.go({0, 0, -0.012});
  EXPECT_NEAR(tool.go({0, 0, -0.005}), 80 * Needle::kNeedle_m, 2 * kForce * 80 * Needle::kNeedle_m);
  const BladeWork work = bladeWork(tool.solver(), 0);
  EXPECT_NEAR(work.parting_j, 80 * work.area_m2 + (500 - 80) * 0.001 * Needle::kNeedle_m, 0.02 * work.parting_j);
  EXPECT_LT(work.parting_j, work.work_j);
  tool.go({0, 0, 0.01});
  EXPECT_NEAR(tool.go({0, 0, 0.015}), 0, 1e-3);
  EXPECT_NEAR(tool.go({0, 0, -0.015}), 0, 0.1 * 80 * Needle::kNeedle_m);
  EXPECT_EQ(tool.solver().health().trips, 0u);
}

TEST(BladePositions, ASavedNeedleGoesOnToTheBit) {
  Needle needle;
  BladePositionsTool first(needle.model, needle.scene, needle.above()),
      second(needle.model, needle.scene, needle.above());
  first.go({0, 0, -0.01});
  Archive saved;
  first.solver().persist(saved);
  Archive read(saved.sections());
  second.solver().persist(read);
  second.put(first);
  first.go({0, 0, -0.01});
  second.go({0, 0, -0.01});
  EXPECT_EQ(stateHash(needle.model, first.solver().readState()), stateHash(needle.model, second.solver().readState()));
  EXPECT_EQ(bladeWork(first.solver(), 0).work_j, bladeWork(second.solver(), 0).work_j);
}

TEST(BladePositions, RandomStrokesOfANeedleThatRubsGiveNothing) {
  Needle needle;
  needle.scene.styluses[0].cut.friction_n_per_m = 30;
  BladePositionsTool tool(needle.model, needle.scene, needle.above());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int stroke = 0; stroke < 40; ++stroke) {
    if (stroke % 10 == 0) tool.solver().reset();
    const Vector3d at(0.02 * any(random), 0.02 * any(random), 0.025), axis(any(random), any(random), 1.5);
    tool.put({at, rotationBetween(Vector3d::UnitZ(), axis.normalized())});
    const double before_j = bladeWork(tool.solver(), 0).work_j;
    const Vector3d offset = -0.03 * axis.normalized() + 0.004 * Vector3d(any(random), any(random), any(random));
    tool.go(offset);
    tool.go(-0.5 * offset);
    EXPECT_GT(bladeWork(tool.solver(), 0).work_j - before_j, -1e-3) << stroke;
  }
  EXPECT_EQ(tool.solver().health().trips, 0u);
}

}  // namespace
}  // namespace viscera
