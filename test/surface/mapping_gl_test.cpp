// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <functional>

#include "surface/reference_mapping.h"
#include "surface/surface_rig.h"
#include "viscera/gpu/context.h"

using namespace viscera;
using namespace viscera::testing;

namespace {

constexpr double kUlp = 1.2e-7;  // [-] spacing of floats at 1
constexpr double kMappingSpacing_m = 0.01;
constexpr double kRadius_m = 0.05;
// The kernel rounds origin, grid step, their product and two sums, each by half an ulp of the largest coordinate.
constexpr double kRestUlps = 4;
// Moved nodes carry their rounding into directions: an ulp of a displacement over a spacing, times an offset of less
// than a spacing, in three axes of two edges, in addition to the above.
constexpr double kMovedUlps = 16;
// A step of a packed normal is 1/511 per axis and rounding errs by half of it; plus float noise.
constexpr double kMappingNormalError = 1.0 / 511;

class SkinMapping : public ::testing::Test {
 protected:
  gpu::Context context_;
};

Body ballBody(const Vector3d& center_m, int n = 10, Weights weights = Weights::kCell) {
  return makeBody(ballSolid(center_m, kRadius_m, kMappingSpacing_m), sphereMesh(center_m, kRadius_m, n), weights);
}

Body sheetBody() {
  return makeBody(blockSolid({8, 8, 1}, kMappingSpacing_m), boxMesh({0, 0, 0.002}, {0.08, 0.08, 0.008}, 12));
}

Body boxBody() {
  return makeBody(blockSolid({4, 3, 5}, kMappingSpacing_m), boxMesh({0, 0, 0}, {0.04, 0.03, 0.05}, 9));
}

/// Returns a deformed position: bending, twist and swelling at once, without any symmetry.
Vector3d mappingDeformed(const Vector3d& x) {
  const double twist = 6 * x.z();
  return {1.1 * x.x() * std::cos(twist) - x.y() * std::sin(twist) + 3 * x.z() * x.z(),
          x.x() * std::sin(twist) + 0.9 * x.y() * std::cos(twist) + 0.004 * std::sin(80 * x.x()), 1.2 * x.z() + 0.1};
}

double largest(const std::vector<Vector3d>& points) {
  double out = 0;
  for (const Vector3d& p : points) out = std::max(out, p.cwiseAbs().maxCoeff());
  return out;
}

/// Compares every vertex and normal of a body with the float64 reference.
void expectAsReference(const SurfaceRig& rig, size_t body, size_t first_vertex) {
  const auto u = rig.ofBody(rig.displacement_m, body);
  const auto nodes = rig.ofBody(rig.nodes, body);
  const ReferenceMapping reference(rig.model.bodies[body].lattice, u, nodes);
  const std::vector<Vector3d> positions = rig.positions(), normals = rig.normals();
  const double tolerance_m = kMovedUlps * kUlp * largest(positions);
  const auto& bindings = rig.model.bodies[body].skin.bindings;
  for (size_t v = 0; v < bindings.size(); ++v) {
    const auto expected = reference.map(bindings[v]);
    ASSERT_LT((positions[first_vertex + v] - expected.position_m).norm(), tolerance_m) << "vertex " << v;
    ASSERT_LT((normals[first_vertex + v] - expected.normal).norm(), kMappingNormalError) << "vertex " << v;
  }
}

}  // namespace

TEST_F(SkinMapping, RestPoseComesBackToFloatRounding) {
  std::vector<Body> bodies;
  for (Weights weights : {Weights::kCell, Weights::kPaper}) {
    bodies.push_back(ballBody({0, 0, 0}, 10, weights));
    bodies.push_back(ballBody({1, -2, 0.5}, 10, weights));
  }
  bodies.push_back(sheetBody());
  bodies.push_back(boxBody());
  bodies.push_back(filledBallBody({0.01, 0.02, 0.03}, kRadius_m, kMappingSpacing_m));
  for (Body& body : bodies) {
    const double tolerance_m = kRestUlps * kUlp * largestCoordinate(body.skin.mesh);
    SurfaceRig rig(std::move(body));
    rig.follow();
    const TriangleMesh& mesh = rig.model.bodies[0].skin.mesh;
    const std::vector<Vector3f> mesh_normals = vertexNormals(mesh);
    const std::vector<Vector3d> positions = rig.positions(), normals = rig.normals();
    for (size_t v = 0; v < positions.size(); ++v) {
      ASSERT_LT((positions[v] - mesh.positions_m[v].cast<double>()).cwiseAbs().maxCoeff(), tolerance_m) << v;
      ASSERT_LT((normals[v] - mesh_normals[v].cast<double>()).norm(), kMappingNormalError) << v;
    }
  }
}

TEST_F(SkinMapping, RigidMotionOfTheNodesMovesTheSkinRigidly) {
  const Eigen::AngleAxisd turn(2.1, Vector3d(1, -2, 0.7).normalized());
  const Vector3d shift(0.12, 0.2, -0.08);
  const auto moved = [&](const Vector3d& x) { return Vector3d(turn * x + shift); };
  std::vector<Body> bodies;
  bodies.push_back(ballBody({0.01, 0.02, 0.03}));
  bodies.push_back(sheetBody());
  bodies.push_back(filledBallBody({0.01, 0.02, 0.03}, kRadius_m, kMappingSpacing_m));
  for (Body& body : bodies) {
    SurfaceRig rig(std::move(body));
    rig.moveNodes(moved);
    rig.follow();
    const TriangleMesh& mesh = rig.model.bodies[0].skin.mesh;
    const std::vector<Vector3f> mesh_normals = vertexNormals(mesh);
    const std::vector<Vector3d> positions = rig.positions(), normals = rig.normals();
    const double tolerance_m = kMovedUlps * kUlp * largest(positions);
    for (size_t v = 0; v < positions.size(); ++v) {
      ASSERT_LT((positions[v] - moved(mesh.positions_m[v].cast<double>())).norm(), tolerance_m) << v;
      ASSERT_LT((normals[v] - turn * mesh_normals[v].cast<double>()).norm(), kMappingNormalError) << v;
    }
  }
}

TEST_F(SkinMapping, StretchMovesVerticesWithTheNodesAndKeepsOffsets) {
  constexpr double kStretch = 0.3;
  SurfaceRig rig(ballBody({0, 0, 0}));
  const auto moved = [&](const Vector3d& x) { return Vector3d((1 + kStretch) * x.x(), x.y(), x.z()); };
  rig.moveNodes(moved);
  rig.follow();
  const std::vector<Vector3d> positions = rig.positions();
  const Skin& skin = rig.model.bodies[0].skin;
  for (size_t v = 0; v < positions.size(); ++v) {
    const layout::vec4& o = skin.bindings[v].offset_constant;
    // Offsets rotate but do not stretch: the error is at most the strain of the offset, plus its rotation by at most
    // the strain.
    const double slack_m = 2 * kStretch * Vector3d(o.x, o.y, o.z).norm() + kMovedUlps * kUlp * kRadius_m;
    ASSERT_LT((positions[v] - moved(skin.mesh.positions_m[v].cast<double>())).norm(), slack_m) << v;
  }
}

TEST_F(SkinMapping, AgreesWithTheReferenceAtEverySize) {
  for (size_t count : {1u, 63u, 64u, 65u, 1234u}) {
    Body body = ballBody({0.01, 0.02, 0.03}, 16);
    body.skin.mesh.positions_m.resize(count);
    body.skin.mesh.triangles.clear();
    body.skin.mesh.parts.clear();
    body.skin.bindings.resize(count);
    SurfaceRig rig(std::move(body));
    ASSERT_EQ(rig.surface.vertices(), count);
    rig.moveNodes(mappingDeformed);
    rig.follow();
    expectAsReference(rig, 0, 0);
  }
}

TEST_F(SkinMapping, EveryBodyFollowsItsOwnNodes) {
  std::vector<Body> bodies;
  bodies.push_back(ballBody({0, 0, 0}));
  bodies.push_back(sheetBody());
  bodies.push_back(ballBody({0.2, 0.1, 0}));
  SurfaceRig rig(std::move(bodies));
  rig.moveNodes(mappingDeformed);
  rig.follow();
  size_t first = 0;
  for (size_t b = 0; b < 3; ++b) {
    expectAsReference(rig, b, first);
    first += rig.model.bodies[b].skin.bindings.size();
  }
  EXPECT_EQ(first, rig.surface.vertices());
}

TEST_F(SkinMapping, SeveredNodesFallBackToTheConstantBasis) {
  SurfaceRig rig(ballBody({0, 0, 0}));
  cutBetween(
      rig.model.bodies[0].lattice, [](const Vector3d& x) { return x.x() > 0.005; }, rig.nodes);
  rig.moveNodes(mappingDeformed);
  rig.follow();
  expectAsReference(rig, 0, 0);
}

TEST_F(SkinMapping, CellsInPartCarryTheirSkinUntilTheyAreCut) {
  SurfaceRig rig(filledBallBody({0, 0, 0}, kRadius_m, kMappingSpacing_m));
  for (const auto& s : rig.model.bodies[0].skin.bindings) ASSERT_NE(s.springs & layout::kInCellBit, 0u);
  rig.moveNodes(mappingDeformed);
  rig.follow();
  expectAsReference(rig, 0, 0);
  cutBetween(
      rig.model.bodies[0].lattice, [](const Vector3d& x) { return x.x() > 0.005; }, rig.nodes);
  rig.follow();
  expectAsReference(rig, 0, 0);
}

TEST_F(SkinMapping, StretchedCellsInPartStretchTheirSkin) {
  constexpr double kStretch = 0.3;
  SurfaceRig rig(filledBallBody({0, 0, 0}, kRadius_m, kMappingSpacing_m));
  const auto moved = [&](const Vector3d& x) { return Vector3d((1 + kStretch) * x.x(), x.y() + 0.2 * x.z(), x.z()); };
  rig.moveNodes(moved);
  rig.follow();
  const std::vector<Vector3d> positions = rig.positions();
  for (size_t v = 0; v < positions.size(); ++v) {
    const Vector3d expected = moved(rig.model.bodies[0].skin.mesh.positions_m[v].cast<double>());
    ASSERT_LT((positions[v] - expected).norm(), kMovedUlps * kUlp * kRadius_m) << v;
  }
}

TEST_F(SkinMapping, CollapsedNodesGiveFiniteVerticesAndUnitNormals) {
  const auto to_a_point = [](const Vector3d&) { return Vector3d(0.1, 0.2, 0.3); };
  const auto to_a_line = [](const Vector3d& x) { return Vector3d(x.sum(), 0, 0); };
  const auto to_an_axis = [](const Vector3d& x) { return Vector3d(0, x.y(), 0); };
  const auto mirrored = [](const Vector3d& x) { return Vector3d(-x); };
  const auto tiny = [](const Vector3d& x) { return Vector3d(1e-25 * x); };
  const auto far_away = [](const Vector3d& x) { return Vector3d(1e25 * x); };
  const std::vector<std::function<Vector3d(const Vector3d&)>> collapses = {to_a_point, to_a_line, to_an_axis,
                                                                           mirrored,   tiny,      far_away};
  std::vector<Body> bodies;
  bodies.push_back(ballBody({0, 0, 0}));
  bodies.push_back(filledBallBody({0, 0, 0}, kRadius_m, kMappingSpacing_m));
  SurfaceRig rig(std::move(bodies));
  for (size_t c = 0; c < collapses.size(); ++c) {
    rig.moveNodes(collapses[c]);
    rig.follow();
    for (const Vector3d& p : rig.positions()) ASSERT_TRUE(p.allFinite()) << "collapse " << c;
    for (const Vector3d& n : rig.normals()) ASSERT_NEAR(n.norm(), 1, 2 * kMappingNormalError) << "collapse " << c;
  }
}

TEST_F(SkinMapping, CollapsedTrianglesKeepTheLengthOfOffsets) {
  const auto to_a_point = [](const Vector3d&) { return Vector3d(0.1, 0.2, 0.3); };
  const auto to_a_line = [](const Vector3d& x) { return Vector3d(x.sum(), 0, 0); };
  const auto to_an_axis = [](const Vector3d& x) { return Vector3d(0, x.y(), 0); };
  const std::vector<std::function<Vector3d(const Vector3d&)>> collapses = {to_a_point, to_a_line, to_an_axis};
  Body body = ballBody({0, 0, 0});
  for (layout::SkinBinding& s : body.skin.bindings) s.springs &= ~layout::kInterpolatedBit;
  SurfaceRig rig(std::move(body));
  const Lattice& lattice = rig.model.bodies[0].lattice;
  for (size_t c = 0; c < collapses.size(); ++c) {
    rig.moveNodes(collapses[c]);
    rig.follow();
    const std::vector<Vector3d> positions = rig.positions();
    const double tolerance_m = kMovedUlps * kUlp * largest(positions);
    for (size_t v = 0; v < positions.size(); ++v) {
      const layout::SkinBinding& s = rig.model.bodies[0].skin.bindings[v];
      const Vector3d reference = s.weights.x * collapses[c](lattice.restPosition(s.slot0)) +
                                 s.weights.y * collapses[c](lattice.restPosition(s.slot1)) +
                                 s.weights.z * collapses[c](lattice.restPosition(s.slot2));
      const Vector3d offset(s.offset_constant.x, s.offset_constant.y, s.offset_constant.z);
      ASSERT_NEAR((positions[v] - reference).norm(), offset.norm(), tolerance_m) << "collapse " << c << ", " << v;
    }
  }
}

TEST_F(SkinMapping, FollowingMakesNoObjectAndCountsItself) {
  SurfaceRig rig(ballBody({0, 0, 0}));
  rig.follow();
  const size_t objects = gpu::objectsCreated();
  const uint64_t mappings = rig.surface.mappings();
  rig.surface.follow(rig.state());
  rig.surface.follow(rig.state());
  EXPECT_EQ(gpu::objectsCreated(), objects);
  EXPECT_EQ(rig.surface.mappings(), mappings + 2);
  EXPECT_NO_THROW(gpu::checkErrors("follow"));
}

TEST_F(SkinMapping, BodyWithoutSkinIsFollowedByNothing) {
  TriangleMesh none;
  none.part_names = {"tissue"};
  SurfaceRig rig(makeBody(blockSolid({2, 2, 2}, kMappingSpacing_m), none));
  rig.follow();
  rig.split();
  EXPECT_EQ(rig.surface.vertices(), 0u);
  EXPECT_EQ(rig.surface.triangles(), 0u);
  EXPECT_NO_THROW(gpu::checkErrors("follow and split"));
}
