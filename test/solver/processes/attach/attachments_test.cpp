// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Bodies grown together: as stiff as one, in balance, torn by the work that they should take (docs/physics.md 17).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "math/archive.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/processes/attach/attached_blocks.h"
#include "solver/processes/attach/attachments.h"
#include "solver/processes/attach/cohesive_law.h"
#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/body/elasticity.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kFinerSpacing_m = 0.002;
constexpr double kAsOne = 0.03;   // of the topMoved_m of one block: the claim of docs/physics.md 17
constexpr int kGlueSettles = 60;  // ticks: drag of 60 per second leaves nothing that can be seen
const char* const kGlue = "modulus_pa: 1.0e+6, thickness_m: 1.0e-4, strength_pa: 1.0e+5, toughness_j_per_m2: 1000";

struct GlueLoad {
  const char* name;
  Vector3d size_m;  ///< of both halves together
  Vector3d gravity_m_per_s2;
};
const GlueLoad kLoads[] = {{"tension", {0.024, 0.024, 0.048}, {0, 0, 10}},
                           {"bending", {0.024, 0.024, 0.048}, {4, 0, 0}},
                           {"shear", {0.036, 0.036, 0.024}, {0, 10, 0}}};

const char* const kGluedMaterial =
    "material: {young_modulus_pa: 20000, poisson_ratio: 0.45, density_kg_per_m3: 1000, mass_damping_per_s: 60}";

Scene gluedScene(const GlueLoad& load, const std::string& bodies, const std::string& attachments) {
  return parseScene("bodies:\n" + bodies + "attachments: [" + attachments +
                        "]\nenvironment: {gravity_m_per_s2: " + listText(load.gravity_m_per_s2) +
                        "}\nsolver: {backend: cpu, threads: 1, sleep_speed_m_per_s: 0}\n",
                    "attached.yaml");
}

std::string heldAtBottom(double height_m) {
  return std::string(kGluedMaterial) + ", fixed: [{shape: plane, point_m: " + listText({0, 0, -0.5 * height_m}) + "}]";
}

/// Returns the mean displacement of the nodes of the upper face.
Vector3d topMoved_m(const GlueLoad& load, const Scene& scene) {
  const Model model = buildModel(scene);
  CpuSolver solver(model, scene);
  for (int t = 0; t < kGlueSettles; ++t) solver.step(ToolMotions{});
  const HostState state = solver.readState();
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (const uint32_t slot : model.bodies[b].lattice.active_slots) {
      if (restPosition(model.bodies[b], slot).z() < load.size_m.z() - 1e-6) continue;
      sum += xyz(state.displacement_m[model.slotOffset(b) + slot]);
      ++count;
    }
  }
  return sum / count;
}

double alone_m(const GlueLoad& load, double spacing_m) {
  return topMoved_m(load,
                    gluedScene(load, boxText("one", load.size_m, 0, spacing_m, heldAtBottom(load.size_m.z())), ""))
      .norm();
}

class GluedBlocks : public ::testing::TestWithParam<int> {};

TEST_P(GluedBlocks, DeformAsOne) {
  for (const GlueLoad& load : kLoads) {
    const double coarse_m = GetParam() * kFinerSpacing_m, half_m = 0.5 * load.size_m.z();
    const Vector3d half(load.size_m.x(), load.size_m.y(), half_m);
    const std::string bodies = boxText("low", half, 0, coarse_m, heldAtBottom(half_m)) +
                               boxText("top", half, half_m, kFinerSpacing_m, kGluedMaterial);
    const double glued_m =
        topMoved_m(load, gluedScene(load, bodies, "{body_a: low, body_b: top, " + std::string(kGlue) + "}")).norm();
    const double one_m = 0.5 * (alone_m(load, kFinerSpacing_m) + alone_m(load, coarse_m));
    EXPECT_NEAR(glued_m / one_m, 1, kAsOne) << load.name;
  }
}
INSTANTIATE_TEST_SUITE_P(Ratios, GluedBlocks, ::testing::Values(1, 2, 3));

struct Totals {
  Vector3d momentum = Vector3d::Zero(), angular = Vector3d::Zero();  ///< N s, N m s
  double kinetic_j = 0;
  double most_ns = 0;  ///< sum of all nodes' momenta as numbers
};

Totals totalsOf(const Model& model, const HostState& state) {
  Totals out;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Strengths strength = strengths(model.bodies[b]);
    for (const uint32_t slot : model.bodies[b].lattice.active_slots) {
      const size_t at = model.slotOffset(b) + slot;
      const auto kg = static_cast<double>(strength.mass_kg[slot]);
      const Vector3d v = xyz(state.velocity_m_per_s[at]);
      const Vector3d x = restPosition(model.bodies[b], slot) + xyz(state.displacement_m[at]);
      out.momentum += kg * v;
      out.angular += kg * x.cross(v);
      out.kinetic_j += 0.5 * kg * v.squaredNorm();
      out.most_ns += kg * v.norm();
    }
  }
  return out;
}

/// Sets velocities: the upper block moves away from the lower one and both turn.
void pushApart(const Model& model, CpuSolver& solver, double apart_m_per_s, double turn_per_s) {
  HostState state = solver.readState();
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (const uint32_t slot : model.bodies[b].lattice.active_slots) {
      const Vector3d x = restPosition(model.bodies[b], slot);
      const Vector3d v =
          Vector3d(0.3, 0.1, b == 0 ? -apart_m_per_s : apart_m_per_s) + turn_per_s * Vector3d(1, 0.5, 0.2).cross(x);
      state.velocity_m_per_s[model.slotOffset(b) + slot] = {static_cast<float>(v.x()), static_cast<float>(v.y()),
                                                            static_cast<float>(v.z()), 0};
    }
  }
  solver.writeState(state, true);
}

constexpr double kKeptMomenta = 5e-7;  // of all nodes' momenta: float32 sums of some 2500 substeps

TEST(Attachments, KeepBothMomentaWhileTheyHoldAndTear) {
  for (const double apart_m_per_s : {0.2, 0.3}) {
    const Scene scene = freeBlocks("modulus_pa: 5000, strength_pa: 500, toughness_j_per_m2: 0.5");
    const Model model = buildModel(scene);
    CpuSolver solver(model, scene);
    pushApart(model, solver, apart_m_per_s, 3);
    const Totals before = totalsOf(model, solver.readState());
    for (int t = 0; t < 50; ++t) solver.step(ToolMotions{});
    const Totals after = totalsOf(model, solver.readState());
    constexpr double kArm_m = 0.16;  // distance that the blocks travel
    EXPECT_LT((after.momentum - before.momentum).norm(), kKeptMomenta * before.most_ns);
    EXPECT_LT((after.angular - before.angular).norm(), kKeptMomenta * before.most_ns * kArm_m);
    EXPECT_GT(factOf(solver, "spent_j"), 0);
  }
}

TEST(Attachments, TakeTheirToughnessTimesTheirAreaWhenTorn) {
  const Scene scene = freeBlocks("modulus_pa: 5000, strength_pa: 500, toughness_j_per_m2: 0.5");
  const Model model = buildModel(scene);
  CpuSolver solver(model, scene);
  pushApart(model, solver, 0.5, 0);
  for (int t = 0; t < 30; ++t) solver.step(ToolMotions{});
  const double area_m2 = 0.012 * 0.012;
  EXPECT_NEAR(factOfFirst(solver, "area_m2"), area_m2, 1e-6 * area_m2);
  EXPECT_EQ(factOfFirst(solver, "attached_m2"), 0);
  EXPECT_NEAR(factOf(solver, "spent_j"), 0.5 * area_m2, 1e-4 * 0.5 * area_m2);
}

TEST(Attachments, DoNotTearUnderPressure) {
  const Scene scene = freeBlocks("modulus_pa: 5000, strength_pa: 20, toughness_j_per_m2: 0.5");
  const Model model = buildModel(scene);
  CpuSolver solver(model, scene);
  pushApart(model, solver, -0.05, 0);
  double stored_j = 0;
  for (int t = 0; t < 2; ++t) {
    solver.step(ToolMotions{});
    stored_j = std::max(stored_j, factOf(solver, "stored_j"));
  }
  EXPECT_GT(stored_j, 0);
  const double area_m2 = 0.012 * 0.012;
  EXPECT_NEAR(factOfFirst(solver, "attached_m2"), area_m2, 1e-6 * area_m2);
}

TEST(Attachments, ActOnTheReferenceAsOnTheCpu) {
  const Scene scene = loadedBlocks();
  const Model model = buildModel(scene);
  CpuSolver solver(model, scene);
  expectToMoveAsTheReference(model, scene, solver, 8);
}

TEST(Attachments, GoOnFromASavedState) {
  const Scene scene = freeBlocks("modulus_pa: 5000, strength_pa: 500, toughness_j_per_m2: 0.5");
  const Model model = buildModel(scene);
  CpuSolver one(model, scene), other(model, scene);
  pushApart(model, one, 0.2, 3);
  for (int t = 0; t < 3; ++t) one.step(ToolMotions{});
  Archive saved;
  one.persist(saved);
  Archive restored(saved.take());
  other.persist(restored);
  restored.end();
  EXPECT_GT(factOf(one, "spent_j"), 0);
  for (int t = 0; t < 5; ++t) {
    one.step(ToolMotions{});
    other.step(ToolMotions{});
  }
  EXPECT_EQ(stateHash(model, one.readState()), stateHash(model, other.readState()));
  EXPECT_EQ(factOf(one, "spent_j"), factOf(other, "spent_j"));
}

TEST(Attachments, RollBacksCloseWhatOpenedSince) {
  const Scene scene = freeBlocks("modulus_pa: 5000, strength_pa: 500, toughness_j_per_m2: 0.5");
  const Model model = buildModel(scene);
  CpuSolver solver(model, scene);
  pushApart(model, solver, 0.2, 3);
  for (int t = 0; t < 1; ++t) solver.step(ToolMotions{});
  auto* const attachments = findProcess<Attachments>(solver);
  ASSERT_TRUE(attachments);
  ASSERT_EQ(attachments->rollBack(), RollBack::kUndo);
  Archive saved;
  saved.section("one");
  attachments->persistUndone(saved);
  const double spent_j = factOf(solver, "spent_j");
  for (int t = 0; t < 2; ++t) solver.step(ToolMotions{});
  EXPECT_GT(factOf(solver, "spent_j"), spent_j);
  Archive restored(saved.take());
  restored.section("one");
  attachments->persistUndone(restored);
  attachments->undone(false);
  EXPECT_EQ(factOf(solver, "spent_j"), spent_j);
}

TEST(CohesiveLaw, TakesItsToughness) {
  for (const double strength_pa : {100.0, 5000.0, 1e6}) {
    const CohesiveLaw law = CohesiveLaw::of(3e6, strength_pa, 20);
    EXPECT_NEAR(law.spent(2 * law.end_m), 20, 1e-9) << strength_pa;
    EXPECT_LE(law.strength_pa, strength_pa);
    EXPECT_EQ(law.secant(0.5 * law.onset_m()), 3e6);
    EXPECT_EQ(law.secant(law.end_m), 0);
    const double at_m = law.onset_m() + 0.25 * (law.end_m - law.onset_m());
    if (law.end_m > law.onset_m()) {
      EXPECT_NEAR(law.secant(at_m) * at_m, 0.75 * law.strength_pa, 1e-9 * strength_pa);
    }
    EXPECT_NEAR(law.weakened(0.25).spent(law.end_m), 5, 1e-9);
  }
}

/// Returns the error of an attachment of two blocks that are 3 mm apart.
std::string attachmentRefusal(const std::string& keys, const std::string& more = "") {
  return messageOf<SceneError>([&] {
    const Scene scene =
        parseScene("bodies:\n" + boxText("low", {0.012, 0.012, 0.008}, 0, 0.004, "fixed: []") +
                       boxText("top", {0.012, 0.012, 0.008}, 0.011, 0.002, "fixed: []") +
                       "  - {name: cloth, source: sheet, structure: surface, box_size_m: [0.02, 0.02, 0.02]}\n" +
                       "attachments: [{" + keys + "}]\n" + more,
                   "s.yaml");
    CpuSolver(buildModel(scene), scene);
  });
}

TEST(Attachments, RefuseWhatTheyCannotJoin) {
  const std::string both = "body_a: low, body_b: top";
  EXPECT_TRUE(
      says(attachmentRefusal("body_a: low, body_b: bottom"), {"s.yaml: attachments[0]: 'body_b'", "found 'bottom'"}));
  EXPECT_TRUE(says(attachmentRefusal("body_a: low, body_b: low"), {"'body_a' and 'body_b' must be different"}));
  EXPECT_TRUE(
      says(attachmentRefusal("body_a: low, body_b: cloth"), {"'body_b' must name a body of structure lattice"}));
  EXPECT_TRUE(says(attachmentRefusal(both), {"attachments[0]: ", "within reach_m = 0.001 m", "0.003 m away"}));
  EXPECT_TRUE(says(attachmentRefusal(both + ", reach_m: 0.005"), {"reach_m is 0.005 m", "at most 0.004 m"}));
  EXPECT_TRUE(
      says(attachmentRefusal(both, "solver: {integrator: pd}\n"), {"attachments needs solver.integrator leapfrog"}));
  EXPECT_TRUE(says(attachmentRefusal(both, "collision: {enabled: true}\n"), {"'collision.enabled' must be false"}));
  EXPECT_TRUE(says(attachmentRefusal(both, "solver: {start: equilibrium}\n"), {"'solver.start' must be rest"}));
}

}  // namespace
}  // namespace viscera
