// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Processes act on the float64 reference as on the CPU backend.
#include <gtest/gtest.h>

#include <functional>

#include "math/vec4.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/processes/blade/blades.h"
#include "solver/processes/burn/burns.h"
#include "solver/processes/clip/clips.h"
#include "solver/reference/reference_ticks.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr double kSameState = 1e-3;  // of the largest displacement: float32 against float64, over some 500 substeps
constexpr double kSameFact = 1e-3;   // of a sum over these substeps

Scene blockWith(const std::string& keys, const std::string& stylus) {
  return parseScene(
      "bodies: [{name: block, source: box, box_size_m: [0.03, 0.02, 0.015], spacing_m: 0.005,\n"
      "  material: {young_modulus_pa: 2000" +
          keys +
          "}, fixed: [{min_m: [-1, -1, -1], max_m: [1, 1, -0.007]}]}]\n"
          "styluses: [{name: hand, " +
          stylus +
          "}]\n"
          "environment: {gravity_m_per_s2: [0, 0, 0]}\n"
          "solver: {backend: cpu, threads: 1, stability_monitor: false, measured_limit: false}\n"
          "cameras: []\n",
      "block.yaml");
}

/// Makes the same ticks on both, and compares the resulting tissue.
void makeTicks(CpuSolver& cpu, ReferenceTicks& reference, int ticks, const std::function<StylusMotion(int)>& tool) {
  for (int t = 0; t < ticks; ++t) {
    ToolMotions motions{};
    motions[0] = tool(t);
    cpu.step(motions);
    reference.step(motions);
  }
  const HostState state = cpu.readState();
  double error_m = 0, largest_m = 0;
  for (const uint32_t slot : reference.solver().active) {
    const Vector3d& truth_m = reference.solver().u_m[slot];
    error_m = std::max(error_m, (xyz(state.displacement_m[slot]) - truth_m).norm());
    largest_m = std::max(largest_m, truth_m.norm());
  }
  EXPECT_GT(largest_m, 1e-5) << "nothing happened";
  EXPECT_LT(error_m, kSameState * largest_m);
  const std::vector<float> cut = reference.solver().state().axial_cut;
  ASSERT_EQ(state.axial_cut.size(), cut.size());
  for (size_t i = 0; i < cut.size(); ++i) ASSERT_NEAR(state.axial_cut[i], cut[i], kSameState) << i;
}

void expectSame(double one, double other) {
  EXPECT_GT(other, 0);
  EXPECT_NEAR(one, other, kSameFact * other);
}

TEST(ReferenceProcesses, BladesCutByTheSameWork) {
  const Scene scene = blockWith(", cut: {toughness_j_per_m2: 20}", "idle: cut");
  const Model model = buildModel(scene);
  CpuSolver cpu(model, scene);
  ReferenceTicks reference(model, scene);
  const auto at = [](int t) { return Pose{{-0.022 + 0.001 * t, 0.001, 0.003}, Quaterniond::Identity()}; };
  makeTicks(cpu, reference, 25, [&](int t) {
    StylusMotion motion;
    motion.present = true;
    motion.mode = ToolMode::kCut;
    motion.from = at(t);
    motion.to = at(t + 1);
    return motion;
  });
  const BladeWork truth = findProcess<Blades>(reference.processes())->done(0);
  expectSame(bladeWork(cpu, 0).area_m2, truth.area_m2);
  expectSame(bladeWork(cpu, 0).work_j, truth.work_j);
}

TEST(ReferenceProcesses, ClipsHoldWithTheSameForce) {
  const Scene scene = blockWith("", "button1: clip, clip: {width_m: 0.006, opening_m: 0.012, jaw_length_m: 0.008}");
  const Model model = buildModel(scene);
  CpuSolver cpu(model, scene);
  ReferenceTicks reference(model, scene);
  makeTicks(cpu, reference, 12, [&](int t) {
    StylusMotion motion;
    motion.present = true;
    motion.mode = t > 0 ? ToolMode::kClip : ToolMode::kNone;
    motion.from = motion.to = Pose{{0, 0, 0.001}, Quaterniond::Identity()};
    motion.opens_from_rad = motion.opens_to_rad = t > 0 ? 0 : 0.5;
    return motion;
  });
  const ClipStates seen = findProcess<Clips>(cpu)->seen();
  const ClipStates truth = findProcess<Clips>(reference.processes())->seen();
  ASSERT_EQ(seen.on.size(), 1U);
  ASSERT_EQ(truth.on.size(), 1U);
  expectSame(seen.on[0].force_n, truth.on[0].force_n);
}

TEST(ReferenceProcesses, BurntTissueShrinksAlike) {
  const Scene scene = blockWith("", "idle: cautery, cautery: {power_w: 30}");
  const Model model = buildModel(scene);
  CpuSolver cpu(model, scene);
  ReferenceTicks reference(model, scene);
  makeTicks(cpu, reference, 40, [&](int) {
    StylusMotion motion;
    motion.present = true;
    motion.mode = ToolMode::kCautery;
    motion.from = motion.to = Pose{{0.0003, 0.0002, 0.0077}, Quaterniond::Identity()};
    return motion;
  });
  const BurnReport truth = findProcess<Burns>(reference.processes())->seen();
  expectSame(findProcess<Burns>(cpu)->seen().given_j, truth.given_j);
  EXPECT_GT(truth.hottest_c, 60);
}

}  // namespace
}  // namespace viscera
