// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/specimens/specimen.h"

#include <gtest/gtest.h>

#include <cmath>

namespace viscera::bench {
namespace {

TEST(Specimen, CubesHaveExactlyTheNodesAsked) {
  EXPECT_EQ(cubeOf(7).nodes(), 343u);
  EXPECT_EQ(edgeOf(42745), 35);
  EXPECT_DOUBLE_EQ(filledShare(cubeOf(7).model), 1);
}

TEST(Specimen, HeartsHaveTheNodesAskedWithinTwoPercentAndAreHollow) {
  const Specimen heart = heartOf(3000);
  EXPECT_NEAR(static_cast<double>(heart.nodes()), 3000, 60);
  EXPECT_LT(filledShare(heart.model), 0.5);
}

TEST(Specimen, MovesInEveryComponentOfEveryNodeSoThatNoNumberIsDenormal) {
  const Specimen cube = cubeOf(9);
  for (uint32_t slot : cube.model.bodies[0].lattice.active_slots) {
    const Vector3d v = xyz(cube.start.velocity_m_per_s[slot]), u = xyz(cube.start.displacement_m[slot]);
    EXPECT_GT(v.cwiseAbs().minCoeff(), 0.01);
    EXPECT_LT(u.norm(), 0.1 * cube.model.bodies[0].lattice.spacing_m) << "springs are no longer in their usual state";
  }
}

TEST(Specimen, FarthestNodeIsThatOfTheDeformedBody) {
  const Specimen cube = cubeOf(3);
  HostState state = restState(cube.model);
  const double edge_m = 2 * cube.model.bodies[0].lattice.spacing_m;
  EXPECT_NEAR(farthestNode(cube.model, state, Vector3d::UnitX()).x(), edge_m, 1e-12);
  const uint32_t slot = cube.model.bodies[0].lattice.active_slots[0];  // at the origin
  state.displacement_m[slot] = vec4({0.5, 0, 0});
  EXPECT_NEAR(farthestNode(cube.model, state, Vector3d::UnitX()).x(), 0.5, 1e-12);
}

TEST(Specimen, CutSpringIsGoneFromBothEnds) {
  const Specimen cube = cubeOf(3);
  const Lattice& lattice = cube.model.bodies[0].lattice;
  std::vector<layout::NodeBits> nodes = cube.start.nodes;
  const uint32_t slot = lattice.active_slots[0];
  cutSpring(lattice, slot, 6, nodes);
  EXPECT_EQ(springCount(nodes[slot], 6), 0u);
  EXPECT_EQ(springCount(nodes[static_cast<size_t>(lattice.neighborSlot(slot, 6))], 7), 0u);
  EXPECT_EQ(nodes[slot].lo & layout::kCellBit, 0u);
  EXPECT_NE(springCount(nodes[slot], 0), 0u);
}

}  // namespace
}  // namespace viscera::bench
