// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Wounds (docs/surface.md): surface and walls of bodies that planes cut, at any angle to the lattice.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/shape/mesh/box_surface.h"
#include "model/skin_shapes.h"
#include "surface/wound_checks.h"
#include "surface/wounds/wound_cells.h"

namespace viscera::testing {
namespace {

constexpr double kWoundSpacing_m = 0.01;
constexpr double kWoundVolume = 1e-4;  // share: slivers between wounds closer than an edge of the surface mesh are not
                                       // shown; a tenth of the required thousandth
constexpr double kWoundGap = 0.02;     // of the spacing: between lips at rest (docs/surface.md)
constexpr double kWoundOff = 0.1;      // of the spacing: lips and walls of a flat cut from its plane
constexpr double kSeam_m = 1e-7;       // float rounding of two bindings of one point to the same nodes

constexpr double kWoundBacksOfBox = 3e-4;  // of pixels, as kBacks: at one angle a coarse wound ends obliquely

void expectClosed(const Wounded& of) {
  EXPECT_EQ(of.wound.holes(), 0u);
  EXPECT_EQ(openEdges(of, of.positions(of.still())), 0u);
  EXPECT_EQ(openEdges(of, of.positions(of.shaken(0.1 * kWoundSpacing_m))), 0u);
}

TEST(Wound, BoxCutThroughIsTwoClosedBodies) {
  for (const Vector3d& normal : anglesOfCuts()) {
    SCOPED_TRACE(::testing::Message() << normal.transpose());
    Wounded box = woundedBox();
    box.cut({0.0403, 0.0352, 0.0304}, normal);
    box.update();
    const std::vector<Vector3d> rest = box.positions(box.still()),
                                shaken = box.positions(box.shaken(0.1 * kWoundSpacing_m));
    expectClosed(box);
    EXPECT_EQ(edgesOf(box).open, 0u);
    EXPECT_EQ(edgesOf(box).shared, 0u);
    EXPECT_LT(seamGap(box, shaken), kSeam_m);
    EXPECT_LT(lipGaps(box, rest).back() / kWoundSpacing_m, kWoundGap);
    EXPECT_NEAR(volume(box, rest) / (0.08 * 0.07 * 0.06), 1, kWoundVolume);
    EXPECT_LT(distancesFromPlane(box, rest, {0.0403, 0.0352, 0.0304}, normal).back() / kWoundSpacing_m, kWoundOff);
  }
}

TEST(Wound, NoBackOfTheSkinIsSeenWhenItGapes) {
  const Vector3d middle(0.0403, 0.0352, 0.0601);
  constexpr double kReach_m = 0.031;
  int none = 0;
  for (const Vector3d& normal : anglesOfCuts()) {
    SCOPED_TRACE(::testing::Message() << normal.transpose());
    Wounded box = woundedBox();
    box.cut(middle, normal, [&](const Vector3d& at) { return (at - middle).norm() < kReach_m; });
    box.update();
    const std::vector<layout::vec4> open = box.heldOpen(middle, normal, kReach_m, 0.6 * kWoundSpacing_m);
    EXPECT_EQ(backsSeen(box, box.positions(box.still()), middle, Vector3d::UnitZ(), kReach_m), 0);
    const double backs = backsSeen(box, box.positions(open), middle, Vector3d::UnitZ(), kReach_m);
    EXPECT_LE(backs, kWoundBacksOfBox);
    none += backs == 0 ? 1 : 0;
  }
  EXPECT_GE(none, 9);  // of ten angles
}

TEST(Wound, ResetShowsTheFirstSkin) {
  Wounded box = woundedBox();
  box.update();
  const std::vector<uint32_t> whole = box.wound.skinTriangles();
  EXPECT_FALSE(box.wound.any());
  EXPECT_EQ(whole.size(), 3 * box.skin.mesh.triangles.size());
  box.cut({0.0403, 0.0352, 0.0304}, Vector3d::UnitX());
  box.update();
  EXPECT_TRUE(box.wound.any());
  box.nodes = box.lattice.nodes;
  std::fill(box.axial_cut.begin(), box.axial_cut.end(), 0.0F);
  box.update();
  EXPECT_FALSE(box.wound.any());
  EXPECT_EQ(box.wound.skinTriangles(), whole);
  EXPECT_EQ(box.wound.bindings().size(), box.skin.bindings.size());
}

TEST(Wound, ErasedNodesLeaveAGrooveWithWalls) {
  Wounded box = woundedBox();
  box.erase([](const Vector3d& at) { return std::abs(at.x() - 0.04) <= 0.001 && at.z() >= 0.045; });
  box.update();
  const std::vector<Vector3d> rest = box.positions(box.still());
  EXPECT_EQ(openEdges(box, rest), 0u);
  // From half way to the neighbours at the sides and below, with its lower edges rounded off by a point per cell.
  const double square_m3 = 0.01 * 0.07 * 0.015, lost_m3 = 0.08 * 0.07 * 0.06 - volume(box, rest);
  EXPECT_GT(lost_m3, 0.65 * square_m3);
  EXPECT_LT(lost_m3, 0.80 * square_m3);
}

TEST(Wound, IncisionTapersAtItsEnds) {
  for (const Vector3d& normal : anglesOfCuts()) {
    SCOPED_TRACE(::testing::Message() << normal.transpose());
    Wounded box = woundedBox();
    const Vector3d middle(0.0403, 0.0352, 0.0601);
    box.cut(middle, normal, [&](const Vector3d& at) { return (at - middle).norm() < 0.031; });
    box.update();
    expectClosed(box);
  }
}

TEST(Wound, CountsWhereItStaysOpenInASkinWithABorder) {
  Wounded box = woundedBox(true);
  box.update();
  EXPECT_EQ(box.wound.holes(), 0u);
  box.cut({0.0403, 0.0352, 0.0304}, Vector3d::UnitX());
  box.update();
  EXPECT_GT(box.wound.holes(), 0u);  // along the top, where there is no surface
  box.makeWhole();
  EXPECT_EQ(box.wound.holes(), 0u);
}

TEST(Wound, CountsEdgesThatLoseAPieceBetweenTwoCuts) {
  // A layer of nodes between two cuts that pass through the same edges of the surface mesh, from 0.0379 to 0.0421.
  Wounded box = woundedBox();
  box.cut({0.0393, 0.0352, 0.0304}, Vector3d::UnitX());
  box.update();
  EXPECT_EQ(box.wound.slivers(), 0u);
  box.cut({0.0407, 0.0352, 0.0304}, Vector3d::UnitX());
  box.update();
  EXPECT_GT(box.wound.slivers(), 0u);
  EXPECT_EQ(openEdges(box, box.positions(box.still())), 0u);
  box.makeWhole();
  EXPECT_EQ(box.wound.slivers(), 0u);
}

TEST(Wound, CutsThatCrossLeaveClosedPieces) {
  const std::vector<Vector3d> normals = anglesOfCuts();
  for (size_t i = 0; i < normals.size(); ++i) {
    SCOPED_TRACE(::testing::Message() << i);
    Wounded box = woundedBox();
    box.cut({0.0403, 0.0352, 0.0304}, normals[i]);
    box.cut({0.0381, 0.0333, 0.0299}, normals[(i + 1) % normals.size()]);
    box.cut({0.0441, 0.0313, 0.0279}, normals[(i + 4) % normals.size()]);
    box.update();
    expectClosed(box);
  }
}

TEST(Wound, PiecesSayWhichTriangleTheyAreOf) {
  constexpr double kOff_m = 1e-6;  // rounding of float bindings and of crossings, far below the mesh's edges of 1 cm
  Wounded box = woundedBox();
  box.cut({0.0403, 0.0352, 0.0304}, Vector3d(1, 2, 3).normalized());
  box.cut({0.0381, 0.0333, 0.0299}, Vector3d(3, -1, 1).normalized());
  box.update();
  const std::vector<uint32_t>&skin = box.wound.skinTriangles(), &sources = box.wound.skinSources();
  ASSERT_EQ(3 * sources.size(), skin.size());
  const TriangleMesh& whole = box.skin.mesh;
  const Lattice& lattice = box.lattice;
  const auto rest = [&](size_t v) -> Vector3d {
    const size_t own = box.wound.ownVertices();
    if (v < own) return whole.positions_m[v].cast<double>();
    return lattice.origin_m + lattice.spacing_m * box.wound.lipVertices()[v - own].point;
  };
  for (size_t i = 0; i < skin.size(); ++i) {
    const auto& corners = whole.triangles[sources[i / 3]];
    const Vector3d a = whole.positions_m[corners[0]].cast<double>();
    const Vector3d ab = whole.positions_m[corners[1]].cast<double>() - a,
                   ac = whole.positions_m[corners[2]].cast<double>() - a, ap = rest(skin[i]) - a;
    const Vector3d normal = ab.cross(ac).normalized();
    EXPECT_NEAR(normal.dot(ap), 0, kOff_m);
    EXPECT_GE(normal.dot(ab.cross(ap)) / ab.norm(), -kOff_m);
    EXPECT_LE(normal.dot(ac.cross(ap)) / ac.norm(), kOff_m);
  }
}

TEST(Wound, BallOfPartialCellsIsClosed) {
  const Vector3d centre(0.051, 0.049, 0.0505);
  const TriangleMesh mesh = weldedSphereMesh(centre, 0.04, 40);
  for (const Vector3d& normal : anglesOfCuts()) {
    SCOPED_TRACE(::testing::Message() << normal.transpose());
    Wounded ball(bindTo(voxeliseByMoments(mesh, kWoundSpacing_m), mesh));
    ball.cut(centre, normal);
    ball.update();
    expectClosed(ball);
    EXPECT_NEAR(volume(ball, ball.positions(ball.still())) / signedVolume(ball.skin.mesh), 1, kWoundVolume);
  }
}

/// Bricks beyond the lattice's bounds hold ghosts of rows of nodes (RowGhost), which are no nodes of wounds.
TEST(Wound, BricksBeyondTheLatticeHaveNoNodes) {
  Lattice lattice = woundedBox().lattice;
  constexpr int kEdge = static_cast<int>(layout::kBrickEdge);
  const int after = (lattice.nodes_per_axis.x() + kEdge - 1) / kEdge;
  for (const Vector3i& at : {Vector3i(after, 0, 0), Vector3i(0, 0, -1)}) {
    layout::Brick brick{};
    brick.coord_x = at.x();
    brick.coord_z = at.z();
    lattice.bricks.push_back(brick);
  }
  const size_t slots = lattice.bricks.size() * layout::kBrickSlots;
  lattice.nodes.resize(slots);
  lattice.labels.resize(slots);
  lattice.cell_labels.resize(slots);
  const CutCells cells(lattice);
  for (const uint32_t slot : lattice.active_slots)
    EXPECT_EQ(cells.slotAt(lattice.nodeAt(slot)), static_cast<int64_t>(slot));
}

}  // namespace
}  // namespace viscera::testing
