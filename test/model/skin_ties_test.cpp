// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <random>

#include "model/skin_shapes.h"
#include "surface/reference_mapping.h"

using namespace viscera;
using namespace viscera::testing;

namespace {

constexpr double kSpacing_m = 0.01;
const Vector3d kCenter_m(0.03, -0.02, 0.05);

}  // namespace

TEST(SkinTies, AreLiveSpringsInClosedGroups) {
  const BoundSkin bound =
      bindTo(ballSolid(kCenter_m, 0.05, kSpacing_m), sphereMesh(kCenter_m, 0.05, 5));  // edges of a spacing
  const Skin& skin = bound.skin;
  ASSERT_EQ(skin.tie_starts.size(), skin.mesh.triangles.size() + 1);
  EXPECT_EQ(skin.tie_starts.back(), skin.ties.size());
  EXPECT_GT(skin.ties.size(), 0u);
  for (size_t t = 0; t + 1 < skin.tie_starts.size(); ++t) {
    if (skin.tie_starts[t] == skin.tie_starts[t + 1]) continue;
    EXPECT_NE(skin.ties[skin.tie_starts[t + 1] - 1].spring & layout::kTieEndBit, 0u);
  }
  for (const layout::Tie& tie : skin.ties) {
    EXPECT_GT(springCount(bound.lattice.nodes[tie.slot], tie.spring & ~layout::kTieEndBit), 0u);
  }
  const std::vector<uint32_t> whole = wholeTriangles(skin, bound.lattice, bound.lattice.nodes);
  EXPECT_EQ(std::count(whole.begin(), whole.end(), 1u), static_cast<long>(whole.size()));
}

TEST(SkinTies, NoCutWhateverItsPlaceLeavesATriangleOnTwoPieces) {
  const BoundSkin shapes[] = {bindTo(ballSolid(kCenter_m, 0.05, kSpacing_m), sphereMesh(kCenter_m, 0.05, 5)),
                              bindTo(creviceSolid(kSpacing_m), creviceMesh(kSpacing_m))};
  std::mt19937 random(7);
  std::normal_distribution<double> gauss;
  for (const BoundSkin& bound : shapes) {
    const Vector3d middle = bound.lattice.origin_m + 0.5 * kSpacing_m * bound.solid.cells.cast<double>();
    for (int trial = 0; trial < 20; ++trial) {
      const Vector3d normal = Vector3d(gauss(random), gauss(random), gauss(random)).normalized();
      const double offset = 0.01 * gauss(random);
      std::vector<layout::NodeBits> nodes = bound.lattice.nodes;
      cutBetween(
          bound.lattice, [&](const Vector3d& at) { return normal.dot(at - middle) > offset; }, nodes);
      const std::vector<uint32_t> piece = pieces(bound.lattice, nodes);
      const std::vector<uint32_t> whole = wholeTriangles(bound.skin, bound.lattice, nodes);
      for (size_t t = 0; t < whole.size(); ++t) {
        if (!whole[t]) continue;
        EXPECT_EQ(piecesOf(bound.skin, t, piece), 1u) << "triangle " << t << ", trial " << trial;
      }
    }
  }
}

TEST(SkinTies, TrianglesBetweenSeparatePiecesAreLeftOutAndCounted) {
  // Two blocks three cells apart under one skin.
  const Solid solid = solidWhere(Vector3d::Zero(), {9, 3, 3}, kSpacing_m,
                                 [](const Vector3d& at) { return at.x() < 0.03 || at.x() > 0.06; });
  const TriangleMesh sheet = sheetMesh({0, 0, 0.03}, {0.09, 0, 0}, {0, 0.03, 0}, 18);
  const BoundSkin bound = bindTo(solid, sheet);
  EXPECT_GT(bound.skin.bridges_removed, 0u);
  EXPECT_EQ(bound.skin.mesh.triangles.size() + bound.skin.bridges_removed, refine(sheet, kSpacing_m).triangles.size());
  EXPECT_EQ(bound.skin.mesh.parts.size(), bound.skin.mesh.triangles.size());
  const std::vector<uint32_t> piece = pieces(bound.lattice, bound.lattice.nodes);
  for (size_t t = 0; t < bound.skin.mesh.triangles.size(); ++t) EXPECT_EQ(piecesOf(bound.skin, t, piece), 1u);
}
