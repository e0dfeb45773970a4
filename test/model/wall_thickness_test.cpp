// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/wall_thickness.h"

#include <gtest/gtest.h>

#include "model/body_samples.h"
#include "viscera/model/body/wall_cells.h"

namespace viscera::test {
namespace {

/// Returns a wall of 4 mm between two spheres. The cavity's surface faces inwards.
Body hollowBall(double spacing_m) {
  TriangleMesh inner = sphereMesh(Vector3f::Zero(), 0.026F, 40);
  for (auto& triangle : inner.triangles) std::swap(triangle[1], triangle[2]);
  return build(meshConfig(joined(sphereMesh(Vector3f::Zero(), 0.030F, 40), inner, true), spacing_m));
}

}  // namespace

TEST(WallThickness, OfAHollowBallIsItsWall) {
  constexpr double kFacets = 0.03;  // share of the wall: the chords of 40 rings are 0.1 mm within the sphere
  const std::optional<WallThickness> walls = wallThickness(hollowBall(0.004));
  ASSERT_TRUE(walls);
  EXPECT_NEAR(walls->least_m, 0.004, kFacets * 0.004);
  EXPECT_NEAR(walls->tenth_m, 0.004, kFacets * 0.004);
  EXPECT_NEAR(walls->median_m, 0.004, kFacets * 0.004);
}

TEST(WallThickness, OfASolidBoxIsItsEdges) {
  const Vector3f size(0.02F, 0.03F, 0.05F);
  const std::optional<WallThickness> walls = wallThickness(build(meshConfig(boxMesh(Vector3f::Zero(), size), 0.005)));
  ASSERT_TRUE(walls);
  EXPECT_NEAR(walls->tenth_m, 0.02, 1e-6);
  EXPECT_NEAR(walls->median_m, 0.03, 1e-6);  // 48 % of the surface is 20 mm from the other side, 32 % 30 mm
}

TEST(WallThickness, ErrorsAreThoseThatWereMeasured) {
  EXPECT_NEAR(expectedWallError(1).most, 0.174, 1e-9);
  EXPECT_NEAR(expectedWallError(1).least, 0.036, 1e-9);
  EXPECT_NEAR(expectedWallError(6).most, 0.022 / 4, 1e-9);
  EXPECT_NEAR(expectedWallError(1, Walls::kRows).most, 0.026, 1e-9);
  EXPECT_NEAR(expectedWallError(cellsForWallError(0.05, Walls::kRows), Walls::kRows).most, 0.05, 1e-6);
  EXPECT_GT(expectedWallError(0.2).most, expectedWallError(0.53).most);
  EXPECT_NEAR(expectedWallError(cellsForWallError(0.05)).most, 0.05, 1e-6);
}

TEST(WallThickness, ANoteSaysWhatErrorToExpectOfThinWalls) {
  const auto saysWalls = [](const Body& body) {
    return std::any_of(body.notes.begin(), body.notes.end(),
                       [](const std::string& note) { return note.find("walls: thinnest ") == 0; });
  };
  EXPECT_TRUE(saysWalls(hollowBall(0.004)));
  EXPECT_FALSE(saysWalls(hollowBall(0.0012)));
}

/// Without the variation, walls of half a cell are too soft in tension; with all of theirs, walls of a cell are too
/// stiff in bending. Ghosts at a clamp need more of it.
TEST(WallCells, TheVariationOfSecondDerivativesThatCountsFallsWithThickness) {
  const auto largest = [](const Body& body, bool at_clamp) {
    double out = 0;
    for (const WallCell& wall : wallCells(body)) {
      bool fixed = false;
      forEachCorner(body.lattice, wall.cell,
                    [&](const Vector3i&, uint32_t slot) { fixed = fixed || isFixed(body.lattice.nodes[slot]); });
      EXPECT_LE(wall.variation, kRowVariation * wall.rows);
      if (fixed == at_clamp) out = std::max(out, wall.variation / wall.rows);
    }
    return out;
  };
  Body one_cell = hollowBall(0.004), half_a_cell = hollowBall(0.0088);
  for (Body* body : {&one_cell, &half_a_cell}) body->material.walls = Walls::kRows;
  EXPECT_NEAR(largest(one_cell, false), 0.1, 1e-9);
  EXPECT_NEAR(largest(half_a_cell, false), kRowVariation, 0.1);
  for (const uint32_t slot : one_cell.lattice.active_slots) {
    if (one_cell.lattice.nodeAt(slot).x() < 3) one_cell.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  EXPECT_NEAR(largest(one_cell, true), 0.25, 1e-9);
  EXPECT_NEAR(largest(one_cell, false), 0.1, 1e-9);
}

}  // namespace viscera::test
