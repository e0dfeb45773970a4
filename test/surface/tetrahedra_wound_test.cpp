// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Wounds of bodies of tetrahedra (docs/wounds.md 4): skin and walls of boxes that planes cut, at any angle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "surface/tetrahedra_rig.h"
#include "surface/wound_checks.h"

namespace viscera::testing {
namespace {

constexpr double kSpacing_m = 0.01;
constexpr double kVolume_m3 = 0.08 * 0.07 * 0.06;
constexpr double kTetrahedraWoundVolume = 1e-6;  // share: float rounding of bindings; pieces of edges fill them
constexpr double kGap = 0.02;                    // of the spacing: between lips at rest (docs/wounds.md)
constexpr double kOff = 0.1;                     // of the spacing: lips and walls of a flat cut from its plane
constexpr double kPlace_m = 1e-7;                // float rounding of bindings in a box of 0.1 m

// Of 3.3 million pixels, as WoundTest's: slivers beside nodes that the blade nearly met turn over at kinks of the pull.
constexpr double kBacksOfBox = 3e-4;

const Vector3d kMiddle(0.0403, 0.0352, 0.0304);

Body boxBody() {
  return tetrahedraBox({8, 7, 6}, kSpacing_m);
}

void expectClosed(const WoundedTetrahedra& of) {
  EXPECT_EQ(edgeCounts(of.sewn()).open, 0u);
  EXPECT_EQ(edgeCounts(of.sewn()).shared, 0u);
  EXPECT_EQ(openEdges(of, of.positions(of.still())), 0u);
  EXPECT_EQ(openEdges(of, of.positions(of.shaken(0.1 * kSpacing_m))), 0u);
}

TEST(TetrahedraWound, BoxCutThroughIsTwoClosedBodies) {
  for (const Vector3d& normal : anglesOfCuts()) {
    SCOPED_TRACE(::testing::Message() << normal.transpose());
    WoundedTetrahedra box(boxBody());
    box.cut(kMiddle, normal);
    box.update();
    expectClosed(box);
    const std::vector<Vector3d> rest = box.positions(box.still());
    EXPECT_NEAR(volume(box, rest) / kVolume_m3, 1, kTetrahedraWoundVolume);
    EXPECT_LT(distancesFromPlane(box, rest, kMiddle, normal).back() / kSpacing_m, kOff);
  }
}

/// Of every vertex that a cut has added, how far it is from the nearest one of the other side [m].
double widestGap(const WoundedTetrahedra& of, const std::vector<Vector3d>& at, const Vector3d& normal) {
  double widest = 0;
  const auto side = [&](size_t v) {
    const auto& added = of.wound.added()[v - of.wound.ownVertices()];
    return normal.dot(of.body.network->positions_m[added.binding.slot0] - kMiddle) >= 0;
  };
  for (size_t v = of.wound.ownVertices(); v < at.size(); ++v) {
    double nearest = 1;
    for (size_t w = of.wound.ownVertices(); w < at.size(); ++w)
      if (side(v) != side(w)) nearest = std::min(nearest, (at[v] - at[w]).norm());
    widest = std::max(widest, nearest);
  }
  return widest;
}

TEST(TetrahedraWound, LipsMeetAtRest) {
  for (const Vector3d& normal : anglesOfCuts()) {
    WoundedTetrahedra box(boxBody());
    box.cut(kMiddle, normal);
    box.update();
    EXPECT_LT(widestGap(box, box.positions(box.still()), normal) / kSpacing_m, kGap);
  }
}

TEST(TetrahedraWound, PieceTakesItsLipsAndWallsAlong) {
  const Eigen::Isometry3d motion =
      Eigen::Translation3d(0.03, -0.05, 0.12) * Eigen::AngleAxisd(2.1, Vector3d(1, -2, 0.5).normalized());
  for (const Vector3d& normal : anglesOfCuts()) {
    SCOPED_TRACE(::testing::Message() << normal.transpose());
    WoundedTetrahedra box(boxBody());
    box.cut(kMiddle, normal);
    box.update();
    const std::vector<Vector3d> rest = box.positions(box.still());
    const std::vector<Vector3d> moved = box.positions(box.movedBeyond(kMiddle, normal, motion));
    size_t with_it = 0;
    for (size_t v = box.wound.ownVertices(); v < rest.size(); ++v) {
      const auto& binding = box.wound.added()[v - box.wound.ownVertices()].binding;
      const bool beyond = normal.dot(box.body.network->positions_m[binding.slot0] - kMiddle) >= 0;
      ASSERT_LT((moved[v] - (beyond ? motion * rest[v] : rest[v])).norm(), kPlace_m) << v;
      with_it += beyond ? 1 : 0;
    }
    EXPECT_GT(with_it, 50u);
    EXPECT_EQ(openEdges(box, moved), 0u);
    EXPECT_NEAR(volume(box, moved) / kVolume_m3, 1, kTetrahedraWoundVolume);
  }
}

TEST(TetrahedraWound, IncisionIsClosed) {
  const Vector3d middle(0.0403, 0.0352, 0.0601);
  for (const Vector3d& normal : anglesOfCuts()) {
    SCOPED_TRACE(::testing::Message() << normal.transpose());
    WoundedTetrahedra box(boxBody());
    box.cut(middle, normal, [&](const Vector3d& at) { return (at - middle).norm() < 0.031; });
    box.update();
    expectClosed(box);
    const std::vector<Vector3d> rest = box.positions(box.still());
    EXPECT_NEAR(volume(box, rest) / kVolume_m3, 1, kTetrahedraWoundVolume);
    EXPECT_LT(distancesFromPlane(box, rest, middle, normal).back() / kSpacing_m, kOff);
  }
}

TEST(TetrahedraWound, NoBackOfTheSkinIsSeenWhenItGapes) {
  const Vector3d middle(0.0403, 0.0352, 0.0601);
  constexpr double kReach_m = 0.031;
  int none = 0;
  for (const Vector3d& normal : anglesOfCuts()) {
    SCOPED_TRACE(::testing::Message() << normal.transpose());
    WoundedTetrahedra box(boxBody());
    box.cut(middle, normal, [&](const Vector3d& at) { return (at - middle).norm() < kReach_m; });
    box.update();
    EXPECT_EQ(backsSeen(box, box.positions(box.still()), middle, Vector3d::UnitZ(), kReach_m), 0);
    const std::vector<Vector3d> open = box.positions(box.heldOpen(middle, normal, kReach_m, 0.6 * kSpacing_m));
    const double backs = backsSeen(box, open, middle, Vector3d::UnitZ(), kReach_m);
    EXPECT_LE(backs, kBacksOfBox);
    none += backs == 0 ? 1 : 0;
  }
  EXPECT_GE(none, 6);  // of ten angles
}

TEST(TetrahedraWound, CutsThatCrossLeaveClosedPieces) {
  const std::vector<Vector3d> normals = anglesOfCuts();
  for (size_t i = 0; i < normals.size(); ++i) {
    SCOPED_TRACE(::testing::Message() << i);
    WoundedTetrahedra box(boxBody());
    box.cut(kMiddle, normals[i]);
    box.cut({0.0381, 0.0333, 0.0299}, normals[(i + 1) % normals.size()]);
    box.cut({0.0441, 0.0313, 0.0279}, normals[(i + 4) % normals.size()]);
    box.update();
    expectClosed(box);
  }
}

TEST(TetrahedraWound, AnySpringsMayBeCut) {
  std::mt19937 random(5);
  for (const double share : {0.02, 0.3, 0.9}) {
    WoundedTetrahedra box(tetrahedraBox({4, 4, 4}, kSpacing_m));
    std::uniform_real_distribution<double> any(0, 1);
    for (size_t s = 0; s < box.spring_cut.size(); ++s)
      if (any(random) < share) box.cutSpring(s, any(random));
    box.update();
    expectClosed(box);
  }
}

TEST(TetrahedraWound, CutsThroughNodesAreClosed) {
  for (const double off_m : {0.0, 1e-6, -1e-6, 1e-4}) {
    WoundedTetrahedra box(boxBody());
    box.cut({0.04 + off_m, 0.035, 0.03}, Vector3d::UnitX());
    box.update();
    expectClosed(box);
    EXPECT_NEAR(volume(box, box.positions(box.still())) / kVolume_m3, 1, kTetrahedraWoundVolume);
    EXPECT_LT(distancesFromPlane(box, box.positions(box.still()), {0.04, 0, 0}, Vector3d::UnitX()).back() / kSpacing_m,
              kOff);
  }
}

TEST(TetrahedraWound, ErasedNodesLeaveAGrooveWithWalls) {
  WoundedTetrahedra box(boxBody());
  box.erase([](const Vector3d& at) { return std::abs(at.x() - 0.04) < 0.001 && at.z() > 0.045; });
  box.update();
  expectClosed(box);
  const double square_m3 = 0.01 * 0.07 * 0.015;  // from half of the way to the nodes beside and below
  const double lost_m3 = kVolume_m3 - volume(box, box.positions(box.still()));
  EXPECT_GT(lost_m3, 0.65 * square_m3);
  EXPECT_LT(lost_m3, 1.0 * square_m3);
}

TEST(TetrahedraWound, ResetShowsTheFirstSkin) {
  WoundedTetrahedra box(boxBody());
  box.update();
  EXPECT_FALSE(box.wound.any());
  const std::vector<uint32_t> whole = box.wound.skinTriangles();
  EXPECT_EQ(whole.size(), 3 * box.body.skin.mesh.triangles.size());
  box.cut(kMiddle, Vector3d(1, 2, 3).normalized());
  box.erase([](const Vector3d& at) { return at.norm() < 0.02; });
  box.update();
  EXPECT_TRUE(box.wound.any());
  box.makeWhole();
  EXPECT_FALSE(box.wound.any());
  EXPECT_EQ(box.wound.skinTriangles(), whole);
  EXPECT_TRUE(box.wound.added().empty());
  EXPECT_TRUE(box.wound.wallTriangles().empty());
}

TEST(TetrahedraWound, PiecesSayWhichTriangleTheyAreOf) {
  WoundedTetrahedra box(boxBody());
  box.cut(kMiddle, Vector3d(1, 2, 3).normalized());
  box.cut({0.0381, 0.0333, 0.0299}, Vector3d(3, -1, 1).normalized());
  box.erase([](const Vector3d& at) { return at.norm() < 0.02; });
  box.update();
  const std::vector<uint32_t>&skin = box.wound.skinTriangles(), &sources = box.wound.skinSources();
  ASSERT_EQ(3 * sources.size(), skin.size());
  const std::vector<Vector3d> rest = box.positions(box.still());
  for (size_t i = 0; i < skin.size(); ++i) {
    const auto& corners = box.body.skin.mesh.triangles[sources[i / 3]];
    const Vector3d a = rest[corners[0]], ab = rest[corners[1]] - a, ac = rest[corners[2]] - a, ap = rest[skin[i]] - a;
    const Vector3d normal = ab.cross(ac).normalized();
    EXPECT_NEAR(normal.dot(ap), 0, kPlace_m);
    EXPECT_GE(normal.dot(ab.cross(ap)) / ab.norm(), -kPlace_m);
    EXPECT_LE(normal.dot(ac.cross(ap)) / ac.norm(), kPlace_m);
  }
}

TEST(TetrahedraWound, WallsKnowHowDeepTheyLie) {
  WoundedTetrahedra box(boxBody());
  box.cut({0.0403, 0.035, 0.03}, Vector3d::UnitX());
  box.update();
  const std::vector<Vector3d> rest = box.positions(box.still());
  for (size_t v = box.wound.firstWallVertex(); v < rest.size(); ++v) {
    const Vector3d low = rest[v], high = Vector3d(0.08, 0.07, 0.06) - rest[v];
    const double deep_m = std::min(low.minCoeff(), high.minCoeff());
    // Depths between nodes are interpolated, so that they are less than exact across the middle.
    EXPECT_NEAR(box.wound.added()[v - box.wound.ownVertices()].depth_m, deep_m, 0.5 * kSpacing_m);
  }
}

}  // namespace
}  // namespace viscera::testing
