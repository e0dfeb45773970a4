// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Lattices that are pulled too hard, by the scene's key; toughness by spacing is measured by `viscera bench blade`.
#include "model/fracture/tearing.h"
#include "model/scene/feature_rules.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "math/archive.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/reference/reference_ticks.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr double kTearingStep_m = 0.001;
constexpr int kTorn = 60;      // ticks: the grip is 6 cm away then
constexpr double kRow = 0.88;  // of the toughness: the share given to springs, docs/physics.md 12
constexpr double kSum = 1e-3;  // of an integral by steps

/// Returns a block that is fixed below, with a grip above.
Scene tearingScene(const std::string& tear, const std::string& more = "") {
  return parseScene(
      "name: tears\nbodies:\n  - {source: box, structure: lattice, box_size_m: [0.04, 0.04, 0.024],\n"
      "     spacing_m: 0.004, material: {young_modulus_pa: 10000" +
          tear +
          "},\n"
          "     fixed: [{shape: box, min_m: [-1, -1, -1], max_m: [1, 1, -0.0115]}]}\n" +
          more +
          "styluses:\n  - {name: hand, idle: grab, grab: {radius_m: 0.008}}\n"
          "environment: {gravity_m_per_s2: [0, 0, 0]}\n"
          "solver: {tick_hz: 100, backend: cpu, integrator: leapfrog}\n",
      "tears.yaml");
}
std::string tearingToughness(double j_per_m2) {
  return ", tear: {toughness_j_per_m2: " + std::to_string(j_per_m2) + "}";
}

/// A stylus that grips the middle of the upper side, and lifts it.
class TearingTool {
 public:
  explicit TearingTool(const Scene& scene) : scene_(scene), model_(buildModel(scene_)), solver_(model_, scene_) {}
  void lift(int first, int last) {
    for (int i = first; i < last; ++i) {
      ToolMotions motions;
      motions[0].mode = ToolMode::kGrab;
      motions[0].present = true;
      motions[0].hold_begins = i == 0;
      motions[0].from.position_m = {0, 0, 0.012 + kTearingStep_m * i};
      motions[0].to.position_m = {0, 0, 0.012 + kTearingStep_m * (i + 1)};
      solver_.step(motions);
      while (solver_.pollStats(stats_, true)) bad_ += stats_.nonfinite;
    }
  }
  double force_n() const { return static_cast<double>(stats_.impulse[0].z) * scene_.solver.tick_hz; }
  uint32_t springsCut() const { return stats_.springs_cut; }
  uint64_t bad() const { return bad_; }
  uint64_t hash() const { return stateHash(model_, solver_.readState()); }
  CpuSolver& solver() { return solver_; }
  const Model& model() const { return model_; }

 private:
  Scene scene_;
  Model model_;
  CpuSolver solver_;
  layout::TickStats stats_{};
  uint64_t bad_ = 0;
};

/// Returns the work to pull a spring apart [J].
double workOf(const TearLaw& law, bool axial, double stiffness_n_per_m) {
  constexpr int kSteps = 10000;
  const double step_m = law.springs[axial ? 0 : 1].end_m / kSteps;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double extension_m = (i + 0.5) * step_m;
    sum += law.left(axial, extension_m) * stiffness_n_per_m * extension_m * step_m;
  }
  return sum;
}

TEST(Tearing, SpringsAcrossASquareTakeTheWorkOfIt) {
  const Model model = buildModel(tearingScene(tearingToughness(10)));
  const TearLaw law = tearLawOf(model.bodies[0]);
  const double k = 0.4 * 10000 * 0.004;
  EXPECT_NEAR((workOf(law, true, k) + 4 * workOf(law, false, k)) / (10 * 0.004 * 0.004), kRow, kSum);
  EXPECT_EQ(law.left(true, -0.001), 1);
  EXPECT_EQ(law.left(true, law.springs[0].onset_m), 1);
  EXPECT_EQ(law.left(false, law.springs[1].end_m), 0);
}

TEST(Tearing, AGripThatPullsTooHardTearsTissueOff) {
  TearingTool tears(tearingScene(tearingToughness(10))), holds(tearingScene(""));
  for (TearingTool* tool : {&tears, &holds}) tool->lift(0, kTorn);
  EXPECT_GT(tears.springsCut(), 0u);
  EXPECT_EQ(holds.springsCut(), 0u);
  EXPECT_LT(tears.force_n(), 0.5 * holds.force_n());
  EXPECT_EQ(tears.bad(), 0u);
  EXPECT_EQ(tears.solver().health().trips, 0u);
}

TEST(Tearing, WhatIsPulledLessIsAsIfThereWereNoKey) {
  TearingTool tough(tearingScene(tearingToughness(1000))), none(tearingScene(""));
  for (TearingTool* tool : {&tough, &none}) tool->lift(0, 5);
  EXPECT_EQ(tough.springsCut(), 0u);
  EXPECT_EQ(tough.hash(), none.hash());
}

TEST(Tearing, TornSpringsAreCutInTheirMiddle) {
  TearingTool tool(tearingScene(tearingToughness(10)));
  tool.lift(0, kTorn);
  const HostState state = tool.solver().readState();
  const Lattice& lattice = tool.model().bodies[0].lattice;
  size_t torn = 0;
  for (const uint32_t slot : lattice.active_slots) {
    for (uint32_t axis = 0; axis < 3; ++axis) {
      const bool gone = springCount(lattice.nodes[slot], 2 * axis) != springCount(state.nodes[slot], 2 * axis);
      EXPECT_EQ(state.axial_cut[3 * slot + axis], gone ? 0.5f : 0.0f);
      torn += gone;
    }
  }
  EXPECT_GT(torn, 0u);
}

TEST(Tearing, SavedStatesGoOnToTheBit) {
  TearingTool first(tearingScene(tearingToughness(10))), second(tearingScene(tearingToughness(10)));
  first.lift(0, 30);
  second.lift(0, 3);
  Archive saved;
  first.solver().persist(saved);
  Archive read(saved.sections());
  second.solver().persist(read);
  first.lift(30, kTorn);
  second.lift(30, kTorn);
  EXPECT_GT(first.springsCut(), 0u);
  EXPECT_EQ(first.hash(), second.hash());
}

TEST(Tearing, AResetMendsIt) {
  TearingTool tool(tearingScene(tearingToughness(10)));
  tool.lift(0, kTorn);
  const uint64_t torn = tool.hash();
  tool.solver().reset();
  tool.lift(0, kTorn);
  EXPECT_EQ(tool.hash(), torn);
}

TEST(Tearing, WhatItDoesNotGoWithIsRefused) {
  const auto refused = [](const std::function<void(Scene&)>& change) {
    Scene scene = tearingScene(tearingToughness(10));
    change(scene);
    try {
      requireFeatures(scene);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused([](Scene&) {}), "");
  const auto names = [](const std::string& error, const std::string& key) {
    return error.find("material.tear.toughness_j_per_m2") != std::string::npos && error.find(key) != std::string::npos;
  };
  EXPECT_TRUE(names(refused([](Scene& s) { s.solver.integrator = Integrator::kPd; }), "solver.integrator leapfrog"));
  EXPECT_TRUE(names(refused([](Scene& s) { s.solver.backend = Backend::kGpu; }), "solver.backend auto or cpu"));
  EXPECT_TRUE(names(refused([](Scene& s) { s.bodies[0].structure = Structure::kExplicit; }), "structure lattice"));
  const Scene tears = tearingScene(tearingToughness(10));
  EXPECT_THROW(ReferenceTicks(buildModel(tears), tears), SceneError);
}

}  // namespace
}  // namespace viscera
