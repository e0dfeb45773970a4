// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "surface/reference_mapping.h"
#include "surface/surface_rig.h"
#include "viscera/gpu/context.h"

using namespace viscera;
using namespace viscera::testing;

namespace {

constexpr double kSpacing_m = 0.01;
constexpr double kRadius_m = 0.05;
// A triangle with an edge of a spacing hangs on nodes at most this far from the plane when it meets a cut.
constexpr double kTornBand_m = 3 * kSpacing_m;

class SkinTearing : public ::testing::Test {
 protected:
  gpu::Context context_;
};

Body ballBody(const Vector3d& center_m = Vector3d::Zero(), int n = 8) {
  return makeBody(ballSolid(center_m, kRadius_m, kSpacing_m), sphereMesh(center_m, kRadius_m, n));
}

long count(const std::vector<uint32_t>& values, uint32_t wanted) {
  return std::count(values.begin(), values.end(), wanted);
}

/// Live indices must be those of the mesh where a triangle is whole and (0, 0, 0) where it is torn.
void expectLiveIndicesMatch(const Surface& surface) {
  const std::vector<uint32_t> alive = surface.alive().read(), live = surface.liveIndices().read();
  const std::vector<uint32_t>& all = surface.skin().indices();
  ASSERT_EQ(live.size(), 3 * alive.size());
  for (size_t i = 0; i < live.size(); ++i) ASSERT_EQ(live[i], alive[i / 3] ? all[i] : 0u);
}

bool beyondPlane(const Vector3d& x) {
  return x.x() > 0.003;
}

}  // namespace

TEST_F(SkinTearing, NothingIsTornAtFirst) {
  SurfaceRig rig(ballBody());
  EXPECT_EQ(count(rig.surface.alive().read(), 1), static_cast<long>(rig.surface.triangles()));
  EXPECT_EQ(rig.surface.liveIndices().read(), rig.surface.skin().indices());
  rig.tear();
  EXPECT_EQ(count(rig.surface.alive().read(), 1), static_cast<long>(rig.surface.triangles()));
  EXPECT_EQ(rig.surface.liveIndices().read(), rig.surface.skin().indices());
}

TEST_F(SkinTearing, CutThroughLeavesNoTriangleAcrossAndTheRestWhole) {
  SurfaceRig rig(ballBody());
  const Lattice& lattice = rig.model.bodies[0].lattice;
  const Skin& skin = rig.model.bodies[0].skin;
  cutBetween(lattice, beyondPlane, rig.nodes);
  rig.tear();
  const std::vector<uint32_t> alive = rig.surface.alive().read();
  const std::vector<uint32_t> piece = pieces(lattice, rig.nodes);
  EXPECT_GT(count(alive, 0), 0);
  for (size_t t = 0; t < alive.size(); ++t) {
    EXPECT_TRUE(!alive[t] || piecesOf(skin, t, piece) == 1) << "triangle " << t;
    const Vector3d corner = skin.mesh.positions_m[skin.mesh.triangles[t][0]].cast<double>();
    EXPECT_TRUE(alive[t] || std::abs(corner.x() - 0.003) < kTornBand_m) << "triangle " << t;
  }
  expectLiveIndicesMatch(rig.surface);
}

TEST_F(SkinTearing, OpenedCutStretchesNoTriangle) {
  constexpr double kGap_m = 0.2;
  SurfaceRig rig(ballBody());
  cutBetween(rig.model.bodies[0].lattice, beyondPlane, rig.nodes);
  rig.moveNodes([](const Vector3d& x) { return Vector3d(x + (beyondPlane(x) ? kGap_m : 0) * Vector3d::UnitX()); });
  rig.tear();
  rig.follow();
  const std::vector<Vector3d> positions = rig.positions();
  const std::vector<uint32_t> live = rig.surface.liveIndices().read();
  constexpr double kLongestEdge_m = 2 * kSpacing_m;  // of a spacing at rest; the constant basis is on both sides
  for (size_t i = 0; i < live.size(); ++i) {
    const size_t next = i % 3 == 2 ? i - 2 : i + 1;
    ASSERT_LT((positions[live[i]] - positions[live[next]]).norm(), kLongestEdge_m);
  }
}

TEST_F(SkinTearing, AgreesWithTheReferenceForCutsOfAnyExtent) {
  for (double reach_m : {-0.02, 0.0, 0.01, 0.03}) {
    SurfaceRig rig(ballBody());
    const Lattice& lattice = rig.model.bodies[0].lattice;
    // Springs across the plane x = 3 mm, but only above a depth: an incision, not a separation.
    std::vector<layout::NodeBits> cut = rig.nodes;
    cutBetween(lattice, beyondPlane, cut);
    for (uint32_t slot : lattice.active_slots) {
      if (lattice.restPosition(slot).z() > reach_m) rig.nodes[slot] = cut[slot];
    }
    rig.tear();
    EXPECT_EQ(rig.surface.alive().read(), wholeTriangles(rig.model.bodies[0].skin, lattice, rig.nodes));
    expectLiveIndicesMatch(rig.surface);
  }
}

TEST_F(SkinTearing, TiesTearTrianglesWhoseVerticesAllHold) {
  const Vector3d aside(0.1, 0, 0);
  std::vector<Body> bodies;
  bodies.push_back(makeBody(creviceSolid(kSpacing_m), creviceMesh(kSpacing_m)));
  bodies.push_back(makeBody(creviceSolid(kSpacing_m, aside), creviceMesh(kSpacing_m, aside)));
  SurfaceRig rig(std::move(bodies));
  const Lattice& lattice = rig.model.bodies[1].lattice;
  const Skin& skin = rig.model.bodies[1].skin;
  std::vector<layout::NodeBits> nodes = rig.ofBody(rig.nodes, 1);
  // Through the floor of the crevice, away from every vertex that bridges it.
  cutBetween(
      lattice, [&](const Vector3d& x) { return x.x() - aside.x() > 0.025; }, nodes);
  std::copy(nodes.begin(), nodes.end(), rig.nodes.begin() + rig.model.slotOffset(1));
  rig.tear();

  std::vector<uint32_t> expected(rig.model.bodies[0].skin.mesh.triangles.size(), 1);
  const std::vector<uint32_t> cut = wholeTriangles(skin, lattice, nodes);
  expected.insert(expected.end(), cut.begin(), cut.end());
  EXPECT_EQ(rig.surface.alive().read(), expected);
  Skin without_ties = skin;
  without_ties.ties.clear();
  without_ties.tie_starts.assign(skin.tie_starts.size(), 0);
  EXPECT_GT(count(wholeTriangles(without_ties, lattice, nodes), 1), count(cut, 1));
}

TEST_F(SkinTearing, OneCutSpringTearsNothing) {
  SurfaceRig rig(ballBody());
  const Lattice& lattice = rig.model.bodies[0].lattice;
  const layout::SkinBinding& s = rig.model.bodies[0].skin.bindings[17];
  const uint32_t spring = s.springs & 31u;
  ASSERT_GT(springCount(rig.nodes[s.slot0], spring), 0u);
  setSpringCount(rig.nodes[s.slot0], spring, 0);
  setSpringCount(rig.nodes[static_cast<size_t>(lattice.neighborSlot(s.slot0, spring))], oppositeSpring(spring), 0);
  rig.tear();
  EXPECT_EQ(count(rig.surface.alive().read(), 0), 0);
}

TEST_F(SkinTearing, TwoCutSpringsOfAVertexTearItsTriangles) {
  SurfaceRig rig(ballBody());
  const Skin& skin = rig.model.bodies[0].skin;
  const uint32_t vertex = skin.mesh.triangles[40][1];
  const layout::SkinBinding& s = skin.bindings[vertex];
  setSpringCount(rig.nodes[s.slot0], s.springs & 31u, 0);
  setSpringCount(rig.nodes[s.slot2], (s.springs >> 10) & 31u, 0);
  rig.tear();
  EXPECT_EQ(rig.surface.alive().read()[40], 0u);
}

TEST_F(SkinTearing, TornStaysTornUntilReset) {
  SurfaceRig rig(ballBody());
  const std::vector<layout::NodeBits> whole = rig.nodes;
  cutBetween(rig.model.bodies[0].lattice, beyondPlane, rig.nodes);
  rig.tear();
  const std::vector<uint32_t> torn = rig.surface.alive().read();
  ASSERT_GT(count(torn, 0), 0);
  rig.nodes = whole;
  rig.tear();
  EXPECT_EQ(rig.surface.alive().read(), torn);
  rig.surface.reset();
  EXPECT_EQ(count(rig.surface.alive().read(), 0), 0);
  EXPECT_EQ(rig.surface.liveIndices().read(), rig.surface.skin().indices());
}

TEST_F(SkinTearing, UnchangedRevisionCostsNoPass) {
  SurfaceRig rig(ballBody());
  cutBetween(rig.model.bodies[0].lattice, beyondPlane, rig.nodes);
  rig.upload();
  rig.surface.tear(rig.state());  // revision 0, as at the start: nothing was cut, so nothing is looked at
  EXPECT_EQ(count(rig.surface.alive().read(), 0), 0);
  rig.tear();
  EXPECT_GT(count(rig.surface.alive().read(), 0), 0);
}

TEST_F(SkinTearing, CutInOneBodyLeavesTheOtherWhole) {
  std::vector<Body> bodies;
  bodies.push_back(ballBody());
  bodies.push_back(ballBody({0.2, 0, 0}));
  SurfaceRig rig(std::move(bodies));
  std::vector<layout::NodeBits> second = rig.ofBody(rig.nodes, 1);
  cutBetween(
      rig.model.bodies[1].lattice, [](const Vector3d& x) { return x.x() > 0.203; }, second);
  std::copy(second.begin(), second.end(), rig.nodes.begin() + rig.model.slotOffset(1));
  rig.tear();
  std::vector<uint32_t> expected(rig.model.bodies[0].skin.mesh.triangles.size(), 1);
  const std::vector<uint32_t> cut = wholeTriangles(rig.model.bodies[1].skin, rig.model.bodies[1].lattice, second);
  EXPECT_GT(count(cut, 0), 0);
  expected.insert(expected.end(), cut.begin(), cut.end());
  EXPECT_EQ(rig.surface.alive().read(), expected);
}

namespace {

/// How far apart the borders of the skin on the two sides of the plane stand: nearest shown vertices, along x [m].
double widthOfCut(const SurfaceRig& rig) {
  const std::vector<uint32_t> alive = rig.surface.alive().read();
  const std::vector<Vector3d> at = rig.positions();
  const Skin& skin = rig.model.bodies[0].skin;
  double before = -1, beyond = 1;
  for (size_t t = 0; t < alive.size(); ++t) {
    if (!alive[t]) continue;
    for (const uint32_t v : skin.mesh.triangles[t]) {
      const bool is_beyond = beyondPlane(skin.mesh.positions_m[v].cast<double>());
      if (is_beyond) beyond = std::min(beyond, at[v].x());
      if (!is_beyond) before = std::max(before, at[v].x());
    }
  }
  return beyond - before;
}

/// What erasing particles does to the nodes of a layer: they lose every spring.
void eraseLayer(const Lattice& lattice, double x_m, std::vector<layout::NodeBits>& nodes) {
  const auto inLayer = [&](uint32_t slot) { return std::abs(lattice.restPosition(slot).x() - x_m) < 0.5 * kSpacing_m; };
  for (uint32_t slot : lattice.active_slots) {
    for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
      if (!springCount(nodes[slot], spring)) continue;
      const auto other = static_cast<uint32_t>(lattice.neighborSlot(slot, spring));
      if (!inLayer(slot) && !inLayer(other)) continue;
      setSpringCount(nodes[slot], spring, 0);
      nodes[slot].lo |= layout::kSeveredBit;
      setSpringCount(nodes[other], oppositeSpring(spring), 0);
      nodes[other].lo |= layout::kSeveredBit;
    }
  }
}

}  // namespace

TEST_F(SkinTearing, ACutBetweenNodesShowsAGapOfUpToASpacingAndParticlesOneOfASpacingMore) {
  constexpr double kEdge_m = 0.005;  // of the skin's triangles, at most: a border is known to that
  const auto widthAfter = [&](const auto& cut) {
    SurfaceRig rig(ballBody(Vector3d::Zero(), 24));
    cut(rig);
    rig.tear();
    rig.follow();
    return widthOfCut(rig);
  };
  const double springs_m =
      widthAfter([](SurfaceRig& rig) { cutBetween(rig.model.bodies[0].lattice, beyondPlane, rig.nodes); });
  const double particles_m = widthAfter([](SurfaceRig& rig) { eraseLayer(rig.model.bodies[0].lattice, 0, rig.nodes); });
  EXPECT_GT(springs_m, 0);
  EXPECT_LT(springs_m, kSpacing_m + kEdge_m);
  EXPECT_NEAR(particles_m - springs_m, kSpacing_m, kEdge_m);
}

TEST_F(SkinTearing, ACutOpensByAsMuchAsItsSidesAreMoved) {
  constexpr double kGap_m = 0.02, kRounding_m = 1e-7;
  SurfaceRig rig(ballBody(Vector3d::Zero(), 24));
  cutBetween(rig.model.bodies[0].lattice, beyondPlane, rig.nodes);
  rig.tear();
  rig.follow();
  const double closed_m = widthOfCut(rig);
  rig.moveNodes([](const Vector3d& x) { return Vector3d(x + (beyondPlane(x) ? kGap_m : 0) * Vector3d::UnitX()); });
  rig.follow();
  EXPECT_NEAR(widthOfCut(rig) - closed_m, kGap_m, kRounding_m);
}
