// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Wounds (docs/wounds.md): skin and walls of bodies that planes cut, at any angle to the lattice.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "model/shape/box_surface.h"
#include "model/skin_shapes.h"
#include "surface/body_wound.h"
#include "surface/reference_mapping.h"
#include "viscera/layout/links.h"

namespace viscera::testing {
namespace {

constexpr double kSpacing_m = 0.01;

/// A lattice with springs that cuts have taken, as a solver records it.
struct Wounded {
  BoundSkin body;
  std::vector<layout::NodeBits> nodes;
  std::vector<float> axial_cut;
  BodyWound wound;

  explicit Wounded(BoundSkin bound)
      : body(std::move(bound)),
        nodes(body.lattice.nodes),
        axial_cut(3 * nodes.size()),
        wound(body.skin, body.lattice) {}

  /// Cuts every spring that crosses a plane where `within(point)` holds. All in metres.
  template <class Within>
  void cut(const Vector3d& on_plane, const Vector3d& normal, Within within) {
    const Lattice& lattice = body.lattice;
    for (const uint32_t slot : lattice.active_slots) {
      for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
        const int64_t other = lattice.neighborSlot(slot, spring);
        if (other < 0 || springCount(nodes[slot], spring) == 0) continue;
        const Vector3d a = lattice.restPosition(slot), b = lattice.restPosition(static_cast<uint32_t>(other));
        const double da = normal.dot(a - on_plane), db = normal.dot(b - on_plane);
        if ((da >= 0) == (db >= 0)) continue;
        const double share = da / (da - db);
        if (!within(Vector3d(a + share * (b - a)))) continue;
        setSpringCount(nodes[slot], spring, 0);
        nodes[slot].lo |= layout::kSeveredBit;
        if (spring < layout::kAxialSprings && spring % 2 == 0)
          axial_cut[3 * slot + spring / 2] = static_cast<float>(share);
      }
    }
  }
  void cut(const Vector3d& on_plane, const Vector3d& normal) {
    cut(on_plane, normal, [](const Vector3d&) { return true; });
  }
  void update() { wound.update(nodes.data(), axial_cut.data()); }

  std::vector<Vector3d> positions(const std::vector<layout::vec4>& displacement_m) const {
    const ReferenceMapping mapping(body.lattice, displacement_m, nodes);
    std::vector<Vector3d> out;
    for (const layout::SkinBinding& binding : wound.bindings()) out.push_back(mapping.map(binding).position_m);
    return out;
  }
  std::vector<layout::vec4> still() const { return std::vector<layout::vec4>(nodes.size(), layout::vec4{0, 0, 0, 0}); }
  std::vector<layout::vec4> shaken(double size_m) const {
    std::vector<layout::vec4> out = still();
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(-static_cast<float>(size_m), static_cast<float>(size_m));
    for (layout::vec4& u : out) u = {any(random), any(random), any(random), 0};
    return out;
  }
  std::vector<uint32_t> triangles() const {
    std::vector<uint32_t> all = wound.skinTriangles();
    all.insert(all.end(), wound.wallTriangles().begin(), wound.wallTriangles().end());
    return all;
  }
};

constexpr double kVolume =
    1e-4;  // share: slivers between wounds closer than a skin edge are not shown; a tenth of the thousandth wanted

using Point = std::array<int64_t, 3>;
constexpr double kSamePlace_m = 1e-8;  // rounding of float bindings in a box of 0.1 m, and far below any edge

Point keyOf(const Vector3d& at) {
  return {std::llround(at.x() / kSamePlace_m / 100), std::llround(at.y() / kSamePlace_m / 100),
          std::llround(at.z() / kSamePlace_m / 100)};
}

/// Edges, welded by where nodes carry their ends, that have not one triangle on either hand.
size_t openEdges(const Wounded& of, const std::vector<Vector3d>& at) {
  std::map<std::pair<Point, Point>, int> balance;
  const std::vector<uint32_t> triangles = of.triangles();
  for (size_t t = 0; t < triangles.size(); t += 3) {
    for (size_t i = 0; i < 3; ++i) {
      const Point a = keyOf(at[triangles[t + i]]), b = keyOf(at[triangles[t + (i + 1) % 3]]);
      if (a == b) continue;
      if (a < b)
        ++balance[{a, b}];
      else
        --balance[{b, a}];
    }
  }
  size_t open = 0;
  for (const auto& [edge, sum] : balance) open += sum != 0 ? 1 : 0;
  return open;
}

double volume(const Wounded& of, const std::vector<Vector3d>& at) {
  double sum = 0;
  const std::vector<uint32_t> triangles = of.triangles();
  for (size_t t = 0; t < triangles.size(); t += 3) {
    sum += at[triangles[t]].dot(at[triangles[t + 1]].cross(at[triangles[t + 2]])) / 6;
  }
  return sum;
}

/// Of rays from all around to places about a point, how many first meet the back of a triangle.
size_t backsSeen(const Wounded& of, const std::vector<Vector3d>& at, const Vector3d& around, double reach_m) {
  constexpr int kViews = 200, kRaysPerView = 25;
  const std::vector<uint32_t> triangles = of.triangles();
  std::mt19937 random(3);
  std::normal_distribution<double> any;
  std::uniform_real_distribution<double> anywhere(-1, 1);
  size_t backs = 0;
  for (int view = 0; view < kViews; ++view) {
    const Vector3d eye =
        Vector3d(0.04, 0.035, 0.03) + 0.3 * Vector3d(any(random), any(random), any(random)).normalized();
    for (int ray = 0; ray < kRaysPerView; ++ray) {
      const Vector3d way = around + reach_m * Vector3d(anywhere(random), anywhere(random), anywhere(random)) - eye;
      double nearest = std::numeric_limits<double>::infinity();
      bool back = false;
      for (size_t t = 0; t < triangles.size(); t += 3) {
        const Vector3d a = at[triangles[t]] - eye, b = at[triangles[t + 1]] - eye, c = at[triangles[t + 2]] - eye;
        const double u = way.dot(b.cross(c)), v = way.dot(c.cross(a)), w = way.dot(a.cross(b)), sum = u + v + w;
        const bool met = (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
        if (!met) continue;
        const double distance = (u * a + v * b + w * c).dot(way) / (sum * way.squaredNorm());
        if (distance <= 0 || distance >= nearest) continue;
        nearest = distance;
        back = sum > 0;
      }
      backs += back ? 1 : 0;
    }
  }
  return backs;
}

Wounded box() {
  const TriangleMesh mesh = boxSurface(Vector3d::Constant(0.0), Vector3d(0.08, 0.07, 0.06), {19, 17, 15});
  return Wounded(bindTo(blockSolid({8, 7, 6}, kSpacing_m), mesh));
}

std::vector<Vector3d> angles() {
  std::vector<Vector3d> out = {Vector3d::UnitX(), Vector3d(1, 1, 0), Vector3d(1, 1, 1)};
  std::mt19937 random(7);
  std::normal_distribution<double> any;
  while (out.size() < 10) out.push_back(Vector3d(any(random), any(random), any(random)));
  for (Vector3d& v : out) v.normalize();
  return out;
}

TEST(Wound, BoxCutThroughIsTwoClosedBodies) {
  for (const Vector3d& normal : angles()) {
    SCOPED_TRACE(::testing::Message() << normal.transpose());
    Wounded box = viscera::testing::box();
    box.cut({0.0403, 0.0352, 0.0304}, normal);
    box.update();
    const std::vector<Vector3d> rest = box.positions(box.still());
    EXPECT_EQ(box.wound.holes(), 0u);
    EXPECT_EQ(openEdges(box, rest), 0u);
    EXPECT_EQ(openEdges(box, box.positions(box.shaken(0.1 * kSpacing_m))), 0u);
    EXPECT_NEAR(volume(box, rest) / (0.08 * 0.07 * 0.06), 1, kVolume);
    double farthest = 0;
    for (size_t v = box.wound.ownVertices(); v < rest.size(); ++v) {
      farthest = std::max(farthest, std::abs(normal.dot(rest[v] - Vector3d(0.0403, 0.0352, 0.0304))));
    }
    EXPECT_LT(farthest / kSpacing_m, 0.1);
  }
}

TEST(Wound, NoBackOfTheSkinIsSeenWhenItGapes) {
  const Vector3d middle(0.0403, 0.0352, 0.0601);
  constexpr double kReach_m = 0.031;
  for (const Vector3d& normal : angles()) {
    SCOPED_TRACE(::testing::Message() << normal.transpose());
    Wounded box = viscera::testing::box();
    box.cut(middle, normal, [&](const Vector3d& at) { return (at - middle).norm() < kReach_m; });
    box.update();
    std::vector<layout::vec4> apart = box.still();
    for (const uint32_t slot : box.body.lattice.active_slots) {
      const Vector3d from = box.body.lattice.restPosition(slot) - middle;
      const double near = std::max(0.0, 1 - from.norm() / kReach_m), side = normal.dot(from) >= 0 ? 1 : -1;
      const Vector3f u = (0.6 * kSpacing_m * near * side * normal).cast<float>();
      apart[slot] = {u.x(), u.y(), u.z(), 0};
    }
    EXPECT_EQ(backsSeen(box, box.positions(apart), middle, kReach_m), 0u);
  }
}

TEST(Wound, ResetShowsTheFirstSkin) {
  Wounded box = viscera::testing::box();
  box.update();
  const std::vector<uint32_t> whole = box.wound.skinTriangles();
  EXPECT_FALSE(box.wound.any());
  EXPECT_EQ(whole.size(), 3 * box.body.skin.mesh.triangles.size());
  box.cut({0.0403, 0.0352, 0.0304}, Vector3d::UnitX());
  box.update();
  EXPECT_TRUE(box.wound.any());
  box.nodes = box.body.lattice.nodes;
  std::fill(box.axial_cut.begin(), box.axial_cut.end(), 0.0F);
  box.update();
  EXPECT_FALSE(box.wound.any());
  EXPECT_EQ(box.wound.skinTriangles(), whole);
  EXPECT_EQ(box.wound.bindings().size(), box.body.skin.bindings.size());
}

TEST(Wound, ErasedNodesLeaveAGrooveWithWalls) {
  Wounded box = viscera::testing::box();
  const Lattice& lattice = box.body.lattice;
  for (const uint32_t slot : lattice.active_slots) {
    const Vector3d at = lattice.restPosition(slot);
    if (std::abs(at.x() - 0.04) > 0.001 || at.z() < 0.045) continue;
    box.nodes[slot].lo &= ~layout::kAxialMask;
    box.nodes[slot].hi &= ~layout::kDiagonalMask;
    box.nodes[slot].lo |= layout::kSeveredBit;
    for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
      const int64_t other = lattice.neighborSlot(slot, spring);
      if (other < 0) continue;
      const auto far = static_cast<size_t>(other);
      setSpringCount(box.nodes[far], oppositeSpring(spring), 0);
      box.nodes[far].lo |= layout::kSeveredBit;
      if (spring < layout::kAxialSprings)
        box.axial_cut[3 * (spring % 2 == 0 ? slot : far) + spring / 2] = layout::kErasedShare;
    }
  }
  box.update();
  const std::vector<Vector3d> rest = box.positions(box.still());
  EXPECT_EQ(openEdges(box, rest), 0u);
  // From half of the way to the nodes beside and below, with its lower edges rounded off by a cell's point each.
  const double square_m3 = 0.01 * 0.07 * 0.015, lost_m3 = 0.08 * 0.07 * 0.06 - volume(box, rest);
  EXPECT_GT(lost_m3, 0.65 * square_m3);
  EXPECT_LT(lost_m3, 0.80 * square_m3);
}

TEST(Wound, IncisionTapersAtItsEnds) {
  for (const Vector3d& normal : angles()) {
    SCOPED_TRACE(::testing::Message() << normal.transpose());
    Wounded box = viscera::testing::box();
    const Vector3d middle(0.0403, 0.0352, 0.0601);
    box.cut(middle, normal, [&](const Vector3d& at) { return (at - middle).norm() < 0.031; });
    box.update();
    EXPECT_EQ(box.wound.holes(), 0u);
    EXPECT_EQ(openEdges(box, box.positions(box.still())), 0u);
    EXPECT_EQ(openEdges(box, box.positions(box.shaken(0.1 * kSpacing_m))), 0u);
  }
}

TEST(Wound, CutsThatCrossLeaveClosedPieces) {
  const std::vector<Vector3d> normals = angles();
  for (size_t i = 0; i < normals.size(); ++i) {
    SCOPED_TRACE(::testing::Message() << i);
    Wounded box = viscera::testing::box();
    box.cut({0.0403, 0.0352, 0.0304}, normals[i]);
    box.cut({0.0381, 0.0333, 0.0299}, normals[(i + 1) % normals.size()]);
    box.cut({0.0441, 0.0313, 0.0279}, normals[(i + 4) % normals.size()]);
    box.update();
    EXPECT_EQ(box.wound.holes(), 0u);
    EXPECT_EQ(openEdges(box, box.positions(box.still())), 0u);
    EXPECT_EQ(openEdges(box, box.positions(box.shaken(0.1 * kSpacing_m))), 0u);
  }
}

TEST(Wound, PiecesSayWhichTriangleTheyAreOf) {
  constexpr double kOff_m = 1e-6;  // rounding of float bindings and of crossings, far below the skin's edges of 1 cm
  Wounded box = viscera::testing::box();
  box.cut({0.0403, 0.0352, 0.0304}, Vector3d(1, 2, 3).normalized());
  box.cut({0.0381, 0.0333, 0.0299}, Vector3d(3, -1, 1).normalized());
  box.update();
  const std::vector<uint32_t>&skin = box.wound.skinTriangles(), &sources = box.wound.skinSources();
  ASSERT_EQ(3 * sources.size(), skin.size());
  const TriangleMesh& whole = box.body.skin.mesh;
  const Lattice& lattice = box.body.lattice;
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
  for (const Vector3d& normal : angles()) {
    SCOPED_TRACE(::testing::Message() << normal.transpose());
    Wounded ball(bindTo(voxeliseByMoments(mesh, kSpacing_m), mesh));
    ball.cut(centre, normal);
    ball.update();
    const std::vector<Vector3d> rest = ball.positions(ball.still());
    EXPECT_EQ(ball.wound.holes(), 0u);
    EXPECT_EQ(openEdges(ball, rest), 0u);
    EXPECT_EQ(openEdges(ball, ball.positions(ball.shaken(0.1 * kSpacing_m))), 0u);
    EXPECT_NEAR(volume(ball, rest) / signedVolume(ball.body.skin.mesh), 1, kVolume);
  }
}

}  // namespace
}  // namespace viscera::testing
