// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Wounds behind blades that tissue resists are closed surfaces along the path of the fronts.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "solver/cpu/cpu_solver.h"
#include "surface/wound_checks.h"
#include "surface/wound_rig.h"
#include "viscera/model/scene/scene.h"

namespace viscera::testing {
namespace {

constexpr double kStep_m = 0.001;
constexpr double kBeside_m = 0.0011;         // offset from a row of nodes
constexpr double kVolume = 1e-5;             // share: float rounding
constexpr double kOffPlane_m = 0.1 * 0.004;  // of a flat cut's lips and walls, as in other wounds

Scene sceneOf(const std::string& structure) {
  return parseScene("name: blades\nbodies:\n  - {source: box, structure: " + structure +
                        ", box_size_m: [0.06, 0.048, 0.012], spacing_m: 0.004,\n"
                        "     material: {young_modulus_pa: 25000, cut: {toughness_j_per_m2: 50}},\n"
                        "     fixed: [{shape: box, min_m: [-1, 0.022, -1], max_m: [1, 1, 1]},\n"
                        "             {shape: box, min_m: [-1, -1, -1], max_m: [1, -0.022, 1]}]}\n"
                        "styluses:\n  - {name: hand, idle: cut, cut: {blade_length_m: 0.02}}\n"
                        "environment: {gravity_m_per_s2: [0, 0, 0]}\n"
                        "solver: {tick_hz: 100, backend: cpu, integrator: leapfrog}\n",
                    "blades.yaml");
}

/// Makes a stroke of an upright blade along x. @param ticks  45 end within the block, 80 beyond it
HostState strokeThrough(const Model& model, const Scene& scene, int ticks) {
  CpuSolver solver(model, scene);
  Vector3d at(-0.031, kBeside_m, -0.01);
  for (int i = 0; i < ticks; ++i) {
    ToolMotions motions;
    motions[0].mode = ToolMode::kCut;
    motions[0].present = true;
    motions[0].from.position_m = at;
    at.x() += kStep_m;
    motions[0].to.position_m = at;
    solver.step(motions);
  }
  solver.step(ToolMotions{});
  return solver.readState();
}

template <class Of>
void expectClosedWound(Of& of) {
  of.update();
  const std::vector<Vector3d> rest = of.positions(of.still());
  EXPECT_EQ(openEdges(of, rest), 0u);
  EXPECT_NEAR(volume(of, rest) / (0.06 * 0.048 * 0.012), 1, kVolume);
  EXPECT_GT(of.wound.wallTriangles().size(), 0u);
  EXPECT_LT(distancesFromPlane(of, rest, {0, kBeside_m, 0}, Vector3d::UnitY()).back(), kOffPlane_m);
}

TEST(BladeWound, OfLatticesIsClosed) {
  for (const std::string structure : {"lattice", "explicit"}) {
    const Scene scene = sceneOf(structure);
    const Model model = buildModel(scene);
    for (const int ticks : {45, 80}) {
      SCOPED_TRACE(structure + " " + std::to_string(ticks));
      const HostState state = strokeThrough(model, scene, ticks);
      Wounded box(model.bodies[0]);
      box.nodes = state.nodes;
      box.axial_cut = state.axial_cut;
      expectClosedWound(box);
    }
  }
}

}  // namespace
}  // namespace viscera::testing
