// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/wall_thickness.h"

#include <gtest/gtest.h>

#include "model/body_samples.h"

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
  EXPECT_NEAR(expectedWallError(1, Walls::kRows).most, 0.041, 1e-9);
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

}  // namespace viscera::test
