// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "surface/cloth_cuts.h"
#include "viscera/gpu/context.h"

namespace viscera {
namespace {

using namespace viscera::testing;
using test::clothBody;

constexpr double kNetworkSplittingSpacing_m = 0.01;
constexpr double kUlp = 1.2e-7;  // [-] spacing of floats at 1
// For a vertex of a sheet 0.2 m wide: its position, and a part of an edge rotated in some ten operations.
constexpr double kPosition_m = 10 * kUlp * 0.2;
// A step of a packed normal is 1/511 per axis and rounding errs by half of it; plus float noise.
constexpr double kNetworkSplittingNormalError = 1.0 / 511;

class NetworkSplitting : public ::testing::Test {
 protected:
  gpu::Context context_;
};

Body networkSplittingCloth(int rows = 20, int columns = 17) {
  return withNetworkSkin(clothBody(rows, columns, kNetworkSplittingSpacing_m));
}

/// Returns the height over a slanted plane that crosses edges at all positions and passes through no node.
double height(const Vector3d& x) {
  return x.x() + 0.31 * x.y() - 0.0037;
}

void apply(SurfaceRig& rig) {
  rig.split();
  rig.follow();
}

/// Returns on which side of the cut a vertex that is a node is.
bool isBeyond(const SurfaceRig& rig, uint32_t vertex) {
  return height(rig.model.bodies[0].skin.mesh.positions_m[vertex].cast<double>()) >= 0;
}

/// Returns a triangle with all its neighbours, near the middle of a cloth, as vertices, which are slots there.
Corners middleTriangle(const Body& body) {
  const auto& triangles = body.skin.mesh.triangles;
  const auto& at = body.skin.mesh.positions_m;
  return *std::min_element(triangles.begin(), triangles.end(), [&](const Corners& a, const Corners& b) {
    return (at[a[0]] + at[a[1]] + at[a[2]]).norm() < (at[b[0]] + at[b[1]] + at[b[2]]).norm();
  });
}

size_t indexOf(const Body& body, const Corners& triangle) {
  const auto& all = body.skin.mesh.triangles;
  return static_cast<size_t>(std::find(all.begin(), all.end(), triangle) - all.begin());
}

void cutEdge(SurfaceRig& rig, uint32_t a, uint32_t b, double share_from_a) {
  cutSpring(rig, 0, springBetween(*rig.model.bodies[0].network, a, b), a < b ? share_from_a : 1 - share_from_a);
}

}  // namespace

TEST_F(NetworkSplitting, NothingIsSplitAtFirst) {
  SurfaceRig rig(networkSplittingCloth());
  apply(rig);
  const std::vector<uint32_t> alive = rig.surface.alive().read(), live = rig.surface.liveIndices().read();
  EXPECT_EQ(std::count(alive.begin(), alive.end(), layout::kShownWhole), static_cast<long>(alive.size()));
  const std::vector<uint32_t>& all = rig.surface.skin().indices();
  ASSERT_EQ(live.size(), 3 * all.size());
  EXPECT_TRUE(std::equal(all.begin(), all.end(), live.begin()));
  EXPECT_EQ(drawnTriangles(rig.surface).size(), alive.size());
}

TEST_F(NetworkSplitting, ClothThatCannotBeCutHasNoVerticesForIt) {
  const SurfaceRig rig(withNetworkSkin(clothBody(20, 17, kNetworkSplittingSpacing_m), false));
  EXPECT_EQ(rig.surface.vertices(), 20u * 17);
  EXPECT_EQ(rig.surface.liveIndices().size(), 3 * rig.surface.triangles());
  EXPECT_TRUE(rig.surface.skin().splits().empty());
}

TEST_F(NetworkSplitting, CutThroughKeepsTheShownAreaAndMakesTwoPieces) {
  SurfaceRig rig(networkSplittingCloth());
  rig.follow();
  const double area_m2 = areaOf(drawnTriangles(rig.surface), rig.positions());
  ASSERT_EQ(countPieces(drawnTriangles(rig.surface)), 1u);
  cutThrough(rig, 0, height);
  apply(rig);
  const std::vector<Corners> drawn = drawnTriangles(rig.surface);
  EXPECT_GT(drawn.size(), rig.surface.triangles());
  EXPECT_EQ(countPieces(drawn), 2u);
  EXPECT_NEAR(areaOf(drawn, rig.positions()), area_m2, kPosition_m * 0.2 * 4);  // rounding of every border
}

TEST_F(NetworkSplitting, NewVerticesLieWhereTheBladeCrossed) {
  SurfaceRig rig(networkSplittingCloth());
  cutThrough(rig, 0, height);
  apply(rig);
  const size_t nodes = rig.model.bodies[0].skin.bindings.size();
  const std::vector<Vector3d> at = rig.positions();
  size_t crossed = 0;
  for (const auto& [v, piece] : drawnPieces(drawnTriangles(rig.surface))) {
    if (v < nodes) continue;
    ++crossed;
    ASSERT_NEAR(height(at[v]), 0, kPosition_m);
  }
  EXPECT_GT(crossed, 40u);
}

TEST_F(NetworkSplitting, NoTriangleJoinsTheTwoSides) {
  SurfaceRig rig(networkSplittingCloth());
  cutThrough(rig, 0, height);
  const Vector3d gap_m(0.5, 0, 0.1);
  rig.moveNodes([&](const Vector3d& x) { return Vector3d(height(x) >= 0 ? x + gap_m : x); });
  apply(rig);
  const std::vector<Vector3d> at = rig.positions();
  double longest_m = 0;
  for (const Corners& t : drawnTriangles(rig.surface)) {
    for (size_t i = 0; i < 3; ++i) longest_m = std::max(longest_m, (at[t[i]] - at[t[(i + 1) % 3]]).norm());
  }
  EXPECT_LT(longest_m, 1.01 * kNetworkSplittingSpacing_m);
}

TEST_F(NetworkSplitting, FlapMovesAsIfItsPieceWereRigid) {
  SurfaceRig rig(networkSplittingCloth());
  cutThrough(rig, 0, height);
  apply(rig);
  const std::vector<Vector3d> rest = rig.positions();
  const Eigen::Isometry3d turn =
      Eigen::Translation3d(0.1, 0.2, -0.1) * Eigen::AngleAxisd(2.1, Vector3d(1, -2, 0.5).normalized());
  rig.moveNodes([&](const Vector3d& x) { return height(x) >= 0 ? turn * x : x; });
  rig.follow();
  const std::vector<Vector3d> at = rig.positions(), normals = rig.normals();
  size_t turned = 0;
  for (const auto& [v, piece] : drawnPieces(drawnTriangles(rig.surface))) {
    const bool beyond = isBeyond(rig, piece);
    turned += beyond && v >= rig.model.bodies[0].skin.bindings.size();
    ASSERT_LT((at[v] - (beyond ? turn * rest[v] : rest[v])).norm(), 2 * kPosition_m) << "vertex " << v;
    const Vector3d up = beyond ? turn.linear() * Vector3d::UnitZ() : Vector3d(Vector3d::UnitZ());
    ASSERT_LT((normals[v] - up).norm(), kNetworkSplittingNormalError) << "vertex " << v;
  }
  EXPECT_GT(turned, 20u);
}

TEST_F(NetworkSplitting, CutThatEndsInATriangleLeavesItWhole) {
  SurfaceRig rig(networkSplittingCloth());
  const Corners t = middleTriangle(rig.model.bodies[0]);
  cutEdge(rig, t[0], t[1], 0.4);
  apply(rig);
  EXPECT_EQ(drawnTriangles(rig.surface).size(), rig.surface.triangles());
}

TEST_F(NetworkSplitting, TwoCrossedEdgesPartTheCornerBetweenThem) {
  for (size_t corner = 0; corner < 3; ++corner) {
    SurfaceRig rig(networkSplittingCloth());
    const Body& body = rig.model.bodies[0];
    const Corners t = middleTriangle(body);
    const uint32_t i = t[corner], j = t[(corner + 1) % 3], k = t[(corner + 2) % 3];
    cutEdge(rig, i, j, 0.25);
    cutEdge(rig, i, k, 0.5);
    apply(rig);
    const size_t index = indexOf(body, t);
    EXPECT_EQ(rig.surface.alive().read()[index], layout::kShownCorner << corner | layout::kShownRest << corner);
    const std::vector<Vector3d> at = rig.positions();
    std::vector<uint32_t> shown;
    appendShown(t.data(), &rig.surface.skin().splits()[6 * index], rig.surface.alive().read()[index], shown);
    ASSERT_EQ(shown.size(), 9u);
    const std::vector<Vector3d> wanted = {at[i],
                                          0.75 * at[i] + 0.25 * at[j],
                                          0.5 * (at[i] + at[k]),
                                          0.75 * at[i] + 0.25 * at[j],
                                          at[j],
                                          at[k],
                                          0.75 * at[i] + 0.25 * at[j],
                                          at[k],
                                          0.5 * (at[i] + at[k])};
    for (size_t n = 0; n < 9; ++n) ASSERT_LT((at[shown[n]] - wanted[n]).norm(), kPosition_m) << n;
    EXPECT_NE(shown[1], shown[3]);  // one copy per side
    EXPECT_NE(shown[2], shown[8]);
  }
}

TEST_F(NetworkSplitting, ThreeCrossedEdgesLeaveThreeCorners) {
  SurfaceRig rig(networkSplittingCloth());
  const Corners t = middleTriangle(rig.model.bodies[0]);
  for (size_t i = 0; i < 3; ++i) cutEdge(rig, t[i], t[(i + 1) % 3], 0.5);
  apply(rig);
  const size_t index = indexOf(rig.model.bodies[0], t);
  EXPECT_EQ(rig.surface.alive().read()[index], 7 * layout::kShownCorner);
  const double whole_m2 = std::sqrt(3) / 4 * kNetworkSplittingSpacing_m * kNetworkSplittingSpacing_m;
  std::vector<uint32_t> shown;
  appendShown(t.data(), &rig.surface.skin().splits()[6 * index], 7 * layout::kShownCorner, shown);
  ASSERT_EQ(shown.size(), 9u);
  for (size_t n = 0; n < 9; n += 3) {
    EXPECT_NEAR(areaOf({{shown[n], shown[n + 1], shown[n + 2]}}, rig.positions()), whole_m2 / 4,
                kPosition_m * kNetworkSplittingSpacing_m);
  }
}

TEST_F(NetworkSplitting, CornerWhoseNodeHangsOnNothingIsNotShown) {
  SurfaceRig rig(networkSplittingCloth());
  const Body& body = rig.model.bodies[0];
  const uint32_t lonely = middleTriangle(body)[0];
  const SpringNetwork& network = *body.network;
  for (size_t i = 0; i < network.springs.size(); ++i) {
    if (network.springs[i].a == lonely || network.springs[i].b == lonely) cutSpring(rig, 0, i, 0.5);
  }
  apply(rig);
  const std::vector<Corners> drawn = drawnTriangles(rig.surface);
  EXPECT_EQ(drawn.size(), rig.surface.triangles() + 6);  // the rest of its six triangles is two each
  for (const Corners& t : drawn) EXPECT_EQ(std::count(t.begin(), t.end(), lonely), 0);
}

TEST_F(NetworkSplitting, TrianglesOfErasedSpringsVanish) {
  SurfaceRig rig(networkSplittingCloth());
  const uint32_t erased = middleTriangle(rig.model.bodies[0])[0];
  const SpringNetwork& network = *rig.model.bodies[0].network;
  for (size_t i = 0; i < network.springs.size(); ++i) {
    if (network.springs[i].a == erased || network.springs[i].b == erased) cutSpring(rig, 0, i, layout::kErasedShare);
  }
  apply(rig);
  EXPECT_EQ(drawnTriangles(rig.surface).size(), rig.surface.triangles() - 6);
}

TEST_F(NetworkSplitting, FlapOfANodeWithoutAWholeTriangleIsNotTurned) {
  SurfaceRig rig(networkSplittingCloth());
  const Body& body = rig.model.bodies[0];
  // A strip between two cuts, one node wide: its triangles all extend across one of them.
  const double middle_m = body.network->positions_m[middleTriangle(body)[0]].y();
  cutThrough(rig, 0, [&](const Vector3d& x) { return x.y() - middle_m + 0.3 * kNetworkSplittingSpacing_m; });
  cutThrough(rig, 0, [&](const Vector3d& x) { return x.y() - middle_m - 0.4 * kNetworkSplittingSpacing_m; });
  rig.moveNodes([](const Vector3d& x) { return Vector3d(x.z(), x.x(), x.y()); });
  apply(rig);
  const std::vector<Vector3d> at = rig.positions(), normals = rig.normals();
  const std::vector<Corners> drawn = drawnTriangles(rig.surface);
  EXPECT_EQ(countPieces(drawn), 3u);
  const uint32_t node = middleTriangle(body)[0], first_split = static_cast<uint32_t>(body.skin.bindings.size());
  EXPECT_LT((normals[node] - Vector3d::UnitZ()).norm(), kNetworkSplittingNormalError);
  size_t seen = 0;
  for (size_t e = 0; e < body.skin.split_edges.size(); ++e) {
    const SplitEdge& edge = body.skin.split_edges[e];
    const float cut = rig.spring_cut[edge.spring];
    if (edge.a != node || cut == 0) continue;
    const Vector3d d = body.network->positions_m[edge.b] - body.network->positions_m[edge.a];
    EXPECT_LT((at[first_split + 2 * e] - (at[node] + cut * d)).norm(), kPosition_m);
    ++seen;
  }
  EXPECT_GT(seen, 0u);
}

TEST_F(NetworkSplitting, VerticesThatAreNotSeenLieOnTheirEdges) {
  SurfaceRig rig(networkSplittingCloth());
  rig.follow();
  const Skin& skin = rig.model.bodies[0].skin;
  const std::vector<Vector3d> at = rig.positions();
  for (size_t e = 0; e < skin.split_edges.size(); ++e) {
    const Vector3d middle = 0.5 * (at[skin.split_edges[e].a] + at[skin.split_edges[e].b]);
    ASSERT_LT((at[skin.bindings.size() + 2 * e] - middle).norm(), kPosition_m);
    ASSERT_LT((at[skin.bindings.size() + 2 * e + 1] - middle).norm(), kPosition_m);
  }
}

TEST_F(NetworkSplitting, NormalsAtACutComeFromTheirOwnSide) {
  SurfaceRig rig(networkSplittingCloth());
  cutThrough(rig, 0, height);
  rig.moveNodes([&](const Vector3d& x) { return Vector3d(x.x(), x.y(), height(x) >= 0 ? 0.05 : 0); });
  apply(rig);
  for (const auto& [v, piece] : drawnPieces(drawnTriangles(rig.surface))) {
    ASSERT_LT((rig.normals()[v] - Vector3d::UnitZ()).norm(), kNetworkSplittingNormalError) << "vertex " << v;
    if (v > 40) break;  // reading back is slow
  }
}

TEST_F(NetworkSplitting, WhatIsDrawnIsWhatIsTold) {
  std::vector<Body> bodies = {clothBody(8, 9, kNetworkSplittingSpacing_m), networkSplittingCloth(),
                              networkSplittingCloth(9, 11)};
  bodies[0].skin = bindNetworkSkin(*bodies[0].network, false);
  SurfaceRig rig(bodies);
  cutThrough(rig, 1, height);
  cutThrough(rig, 1, [](const Vector3d& x) { return x.y() - 0.7 * x.x() + 0.011; });
  cutThrough(rig, 2, [](const Vector3d& x) { return x.y() + 0.004; });
  apply(rig);
  const std::vector<uint32_t> alive = rig.surface.alive().read(), &indices = rig.surface.skin().indices();
  std::vector<uint32_t> shown;
  for (size_t t = 0; t < alive.size(); ++t) {
    appendShown(&indices[3 * t], &rig.surface.skin().splits()[6 * t], alive[t], shown);
  }
  std::vector<Corners> expected;
  for (size_t i = 0; i < shown.size(); i += 3) expected.push_back({shown[i], shown[i + 1], shown[i + 2]});
  std::vector<Corners> drawn = drawnTriangles(rig.surface);
  std::sort(expected.begin(), expected.end());
  std::sort(drawn.begin(), drawn.end());
  EXPECT_EQ(drawn, expected);
  EXPECT_EQ(countPieces(drawn), 1u + 4 + 2);
}

TEST_F(NetworkSplitting, SplitStaysUntilReset) {
  SurfaceRig rig(networkSplittingCloth());
  rig.follow();
  const std::vector<float> rest = rig.surface.positions().read();
  const std::vector<layout::NodeBits> whole = rig.nodes;
  cutThrough(rig, 0, height);
  rig.moveNodes([&](const Vector3d& x) { return Vector3d(2 * x); });
  apply(rig);
  std::fill(rig.spring_cut.begin(), rig.spring_cut.end(), 0.0f);
  rig.nodes = whole;
  rig.surface.reset();
  rig.moveNodes([&](const Vector3d& x) { return x; });
  rig.follow();
  EXPECT_EQ(drawnTriangles(rig.surface).size(), rig.surface.triangles());
  EXPECT_EQ(rig.surface.positions().read(), rest);
}

TEST_F(NetworkSplitting, LatticeOfLinksBeforeAClothShiftsItsSprings) {
  Body block = makeBody(blockSolid({4, 3, 5}, kNetworkSplittingSpacing_m), boxMesh({0, 0, 0}, {0.04, 0.03, 0.05}, 4));
  block.network = latticeNetwork(block);
  SurfaceRig rig({block, networkSplittingCloth()});
  cutThrough(rig, 1, height);
  apply(rig);
  const std::vector<uint32_t> alive = rig.surface.alive().read();
  const size_t of_block = block.skin.mesh.triangles.size();
  EXPECT_EQ(std::count(alive.begin(), alive.begin() + static_cast<long>(of_block), 1u), static_cast<long>(of_block));
  std::vector<Corners> drawn = drawnTriangles(rig.surface);
  drawn.erase(drawn.begin(), drawn.begin() + static_cast<long>(of_block));
  EXPECT_EQ(countPieces(drawn), 2u);
}

}  // namespace viscera
