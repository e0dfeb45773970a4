// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Blades in tissue of every structure that resists them, by the scene's key; forces by spacing and toughness are
// measured by `viscera bench blade`.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "math/archive.h"
#include "math/decompositions.h"
#include "model/fracture/toughness.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/processes/blade/blades.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr double kBladeStructuresStep_m = 0.001, kStart_m = -0.031;
constexpr double kBeside_m = 0.001;    // offset from a row of nodes
constexpr double kOfLaw = 0.05;        // of force, area and work
constexpr double kFront_m = 0.003;     // the front bends at the surface, and the area counts its mean
constexpr double kShare = 0.15;        // of a spring: a front stays in its plane
constexpr double kCounted_m = 0.0006;  // area is counted in steps of up to an eighth of a spring
constexpr double kPulled = 1e-3;       // of the plateau: tissue that moves into the blade as it returns
constexpr double kOfPlateau = 0.02;    // of the plateau: in its own wound a blade feels nothing

struct Kind {
  std::string name, keys;
  double width_m;  ///< of the cut
};
const std::vector<Kind> kKinds = {
    {"lattice", "source: box, structure: lattice, box_size_m: [0.06, 0.048, 0.012]", 0.012},
    {"explicit", "source: box, structure: explicit, box_size_m: [0.06, 0.048, 0.012]", 0.012},
    {"sheet", "source: sheet, structure: surface, thickness_m: 0.001, box_size_m: [0.06, 0.048, 0.001]", 0.001}};

/// Returns a body fixed on both flanks. @param cut  text in material: ", cut: {...}" or nothing
std::string bodyText(const Kind& kind, const std::string& cut, double z_m = 0) {
  return "  - {name: body" + std::to_string(std::lround(1e3 * z_m)) + ", " + kind.keys +
         ", spacing_m: 0.004, position_m: [0, 0, " + std::to_string(z_m) + "], material: {young_modulus_pa: 25000" +
         cut +
         "},\n     fixed: [{shape: box, min_m: [-1, 0.022, -1], max_m: [1, 1, 1]},\n"
         "             {shape: box, min_m: [-1, -1, -1], max_m: [1, -0.022, 1]}]}\n";
}
std::string toughness(double j_per_m2) {
  return ", cut: {toughness_j_per_m2: " + std::to_string(j_per_m2) + "}";
}
Scene sceneOf(const std::string& bodies) {
  return parseScene("name: blades\nbodies:\n" + bodies +
                        "styluses:\n  - {name: hand, idle: cut, cut: {blade_length_m: 0.04}}\n"
                        "environment: {gravity_m_per_s2: [0, 0, 0]}\n"
                        "solver: {tick_hz: 100, backend: cpu, integrator: leapfrog}\n",
                    "blades.yaml");
}

/// A stylus that pushes an upright blade along x, one step per tick.
class BladeStructuresTool {
 public:
  explicit BladeStructuresTool(const Scene& scene)
      : scene_(scene), model_(buildModel(scene_)), solver_(model_, scene_) {}
  /// Moves to x. @returns the force on the tissue
  Vector3d to(double x_m) {
    ToolMotions motions;
    motions[0].mode = ToolMode::kCut;
    motions[0].present = true;
    motions[0].from.position_m = at_;
    at_.x() = x_m;
    motions[0].to.position_m = at_;
    solver_.step(motions);
    while (solver_.pollStats(stats_, true)) bad_ += stats_.nonfinite;
    return Vector3d(stats_.impulse[0].x, stats_.impulse[0].y, stats_.impulse[0].z) * scene_.solver.tick_hz;
  }
  /// Makes a stroke of a blade at any angle, forward and back.
  void stroke(Pose pose, const Vector3d& offset_m) {
    solver_.step(ToolMotions{});
    for (int tick = 0; tick < 10; ++tick) {
      ToolMotions motions;
      motions[0].mode = ToolMode::kCut;
      motions[0].present = true;
      motions[0].from = pose;
      pose.position_m += (tick < 7 ? 0.1 : -0.1) * offset_m;
      motions[0].to = pose;
      solver_.step(motions);
      while (solver_.pollStats(stats_, true)) bad_ += stats_.nonfinite;
    }
  }
  void push(int first, int last) {
    for (int i = first; i < last; ++i) to(kStart_m + kBladeStructuresStep_m * i);
  }
  void appearAt(double x_m) { at_.x() = x_m; }
  CpuSolver& solver() { return solver_; }
  const Model& model() const { return model_; }
  uint64_t bad() const { return bad_; }
  uint64_t hash() const { return stateHash(model_, solver_.readState()); }
  uint32_t springsCut() const { return stats_.springs_cut; }

 private:
  Scene scene_;
  Model model_;
  CpuSolver solver_;
  Vector3d at_{kStart_m, kBeside_m, -0.01};
  layout::TickStats stats_{};
  uint64_t bad_ = 0;
};

class BladeStructures : public ::testing::TestWithParam<size_t> {
 protected:
  const Kind& kind() const { return kKinds[GetParam()]; }
  Scene scene(double j_per_m2) const { return sceneOf(bodyText(kind(), toughness(j_per_m2))); }
};

TEST_P(BladeStructures, ForceAreaAndWorkAreTheLaws) {
  BladeStructuresTool tool(scene(50));
  const double law_n = 50 * kind().width_m;
  double sum = 0, low = 1e9, high = 0;
  tool.push(0, 30);
  const BladeWork before = bladeWork(tool.solver(), 0);
  for (int i = 30; i < 46; ++i) {
    const double force = tool.to(kStart_m + kBladeStructuresStep_m * i).x();
    sum += force / 16;
    low = std::min(low, force);
    high = std::max(high, force);
  }
  const BladeWork work = bladeWork(tool.solver(), 0);
  EXPECT_NEAR(sum / law_n, 1, kOfLaw);
  EXPECT_LT((high - low) / law_n, 0.1);
  EXPECT_NEAR((work.area_m2 - before.area_m2) / kind().width_m, 0.016, kOfLaw * 0.016 + kCounted_m);
  EXPECT_NEAR((work.work_j - before.work_j) / (0.016 * law_n), 1, kOfLaw);
  EXPECT_NEAR(work.parting_j, 50 * work.area_m2, 0.2 * work.parting_j);  // less of it where the edge entered
  EXPECT_EQ(tool.bad(), 0u);
  EXPECT_EQ(tool.solver().health().trips, 0u);
}

TEST_P(BladeStructures, FeelsNothingInItsOwnWound) {
  BladeStructuresTool tool(scene(50));
  double x = kStart_m, most = 0;
  for (; x < 0.014; x += kBladeStructuresStep_m) most = std::max(most, tool.to(x).x());
  EXPECT_GT(most, 0.9 * 50 * kind().width_m);
  for (; x > -0.012; x -= kBladeStructuresStep_m) EXPECT_GE(tool.to(x).x(), -kPulled * most);
  const double area_m2 = bladeWork(tool.solver(), 0).area_m2;
  for (; x < 0; x += kBladeStructuresStep_m) EXPECT_LT(tool.to(x).norm(), kOfPlateau * most);
  EXPECT_NEAR(bladeWork(tool.solver(), 0).area_m2, area_m2, kOfPlateau * area_m2);
}

/// The test needs the rest positions of the springs' ends, so it is for networks only.
TEST_P(BladeStructures, SpringsGoWhereTheFrontHasPassed) {
  BladeStructuresTool tool(scene(50));
  tool.push(0, 40);
  EXPECT_GT(tool.springsCut(), 0u);
  const Body& body = tool.model().bodies[0];
  if (!body.network) return;
  const double front_m = kStart_m + bladeWork(tool.solver(), 0).area_m2 / kind().width_m;
  const HostState state = tool.solver().readState();
  for (size_t s = 0; s < body.network->springs.size(); ++s) {
    const Vector3d a = body.network->positions_m[body.network->springs[s].a],
                   b = body.network->positions_m[body.network->springs[s].b];
    const bool crosses = (a.y() - kBeside_m) * (b.y() - kBeside_m) < 0;
    const double share = crosses ? (kBeside_m - a.y()) / (b.y() - a.y()) : 0;
    const double x = a.x() + share * (b.x() - a.x());
    SCOPED_TRACE(::testing::Message() << a.transpose() << " to " << b.transpose());
    if (!crosses || x > front_m + kFront_m) {
      EXPECT_EQ(state.spring_cut[s], 0);
    } else if (x < front_m - kFront_m) {
      EXPECT_NEAR(state.spring_cut[s], share, kShare);
    }
  }
}

TEST_P(BladeStructures, RandomStrokesStayFinite) {
  BladeStructuresTool tool(scene(200));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int stroke = 0; stroke < 40; ++stroke) {
    if (stroke % 20 == 19) tool.solver().reset();
    Pose pose{{0.03 * any(random), 0.024 * any(random), 0.012 * any(random)}, Quaterniond::Identity()};
    const Vector3d axis(any(random), any(random), 1.2 * any(random));
    pose.orientation = rotationBetween(Vector3d::UnitZ(), axis.normalized());
    const double x = any(random), y = any(random), z = any(random);
    tool.stroke(pose, Vector3d(0.1 * x, 0.1 * y, 0.05 * z));
  }
  EXPECT_GT(bladeWork(tool.solver(), 0).area_m2, 0);
  EXPECT_EQ(tool.bad(), 0u);
  EXPECT_EQ(tool.solver().health().trips, 0u);
}

TEST_P(BladeStructures, SavedFrontsGoOnToTheBit) {
  BladeStructuresTool first(scene(50)), second(scene(50));
  first.push(0, 25);
  second.push(0, 3);
  Archive saved;
  first.solver().persist(saved);
  Archive read(saved.sections());
  second.solver().persist(read);
  second.appearAt(kStart_m + kBladeStructuresStep_m * 24);
  first.push(25, 35);
  second.push(25, 35);
  EXPECT_EQ(first.hash(), second.hash());
  EXPECT_EQ(bladeWork(first.solver(), 0).work_j, bladeWork(second.solver(), 0).work_j);
}

TEST_P(BladeStructures, ZeroIsAsIfThereWereNoKey) {
  BladeStructuresTool zero(sceneOf(bodyText(kind(), toughness(0)))), none(sceneOf(bodyText(kind(), "")));
  zero.push(0, 40);
  none.push(0, 40);
  EXPECT_GT(zero.springsCut(), 0u);
  EXPECT_EQ(zero.springsCut(), none.springsCut());
  EXPECT_EQ(zero.hash(), none.hash());
}

/// Two bodies one above the other, one of which resists: the blade passes through both.
TEST_P(BladeStructures, OneResistsBesideOneThatDoesNot) {
  const std::string above = bodyText(kind(), "", 0.016), resists = bodyText(kind(), toughness(50));
  BladeStructuresTool both(sceneOf(resists + above)), alone(sceneOf(resists)), free(sceneOf(above));
  for (BladeStructuresTool* tool : {&both, &alone, &free}) tool->push(0, 40);
  EXPECT_EQ(bladeWork(both.solver(), 0).area_m2, bladeWork(alone.solver(), 0).area_m2);
  EXPECT_EQ(bladeWork(both.solver(), 0).work_j, bladeWork(alone.solver(), 0).work_j);
  EXPECT_GT(free.springsCut(), 0u);
  EXPECT_EQ(both.springsCut(), alone.springsCut() + free.springsCut());
}

INSTANTIATE_TEST_SUITE_P(All, BladeStructures, ::testing::Range(size_t{0}, kKinds.size()),
                         [](const ::testing::TestParamInfo<size_t>& of) { return kKinds[of.param].name; });

}  // namespace
}  // namespace viscera
