// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Wounds where tissue tears under a grip are closed surfaces, as those of blades are.
#include <gtest/gtest.h>

#include <vector>

#include "solver/cpu/cpu_solver.h"
#include "surface/wound_checks.h"
#include "surface/wound_rig.h"
#include "viscera/model/scene/scene.h"

namespace viscera::testing {
namespace {

constexpr double kTearWoundVolume = 1e-3;  // share: slivers between tears closer than a spring are left out (2e-4)
constexpr double kTearWoundStep_m = 0.001;
constexpr int kTicks = 60;  // the grip is 6 cm away then

/// Returns a block that is fixed below, with a grip that lifts its upper side until it tears.
Scene scene() {
  return parseScene(
      "name: tears\nbodies:\n  - {source: box, structure: lattice, box_size_m: [0.04, 0.04, 0.024], spacing_m: 0.004,\n"
      "     material: {young_modulus_pa: 10000, tear: {toughness_j_per_m2: 10}},\n"
      "     fixed: [{shape: box, min_m: [-1, -1, -1], max_m: [1, 1, -0.0115]}]}\n"
      "styluses:\n  - {name: hand, idle: grab, grab: {radius_m: 0.008}}\n"
      "environment: {gravity_m_per_s2: [0, 0, 0]}\n"
      "solver: {tick_hz: 100, backend: cpu, integrator: leapfrog}\n",
      "tears.yaml");
}

TEST(TearWound, IsClosed) {
  const Scene of = scene();
  const Model model = buildModel(of);
  CpuSolver solver(model, of);
  for (int i = 0; i < kTicks; ++i) {
    ToolMotions motions;
    motions[0].mode = ToolMode::kGrab;
    motions[0].present = true;
    motions[0].hold_begins = i == 0;
    motions[0].from.position_m = {0, 0, 0.012 + kTearWoundStep_m * i};
    motions[0].to.position_m = {0, 0, 0.012 + kTearWoundStep_m * (i + 1)};
    solver.step(motions);
  }
  const HostState state = solver.readState();
  Wounded box(model.bodies[0]);
  box.nodes = state.nodes;
  box.axial_cut = state.axial_cut;
  box.update();
  const std::vector<Vector3d> rest = box.positions(box.still());
  EXPECT_GT(box.wound.wallTriangles().size(), 0u);
  EXPECT_EQ(openEdges(box, rest), 0u);
  EXPECT_NEAR(volume(box, rest) / (0.04 * 0.04 * 0.024), 1, kTearWoundVolume);
}

}  // namespace
}  // namespace viscera::testing
