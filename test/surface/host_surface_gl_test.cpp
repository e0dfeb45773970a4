// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The surface mesh on the host against that on the GPU, from the same shaders' text.
#include "surface/follow/host_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "surface/cloth_cuts.h"
#include "surface/reference_mapping.h"
#include "surface/surface_rig.h"
#include "viscera/gpu/context.h"

using namespace viscera;
using namespace viscera::test;
using namespace viscera::testing;

namespace {

constexpr double kSpacing_m = 0.01;
constexpr double kPosition_m = 1e-6;        // float rounding of positions of some centimetres
constexpr double kNormalError = 2.0 / 511;  // a step of a packed normal per axis: rounding may go either way

Vector3d deformed(const Vector3d& x) {
  const double twist = 6 * x.z();
  return {1.1 * x.x() * std::cos(twist) - x.y() * std::sin(twist) + 3 * x.z() * x.z(),
          x.x() * std::sin(twist) + 0.9 * x.y() * std::cos(twist) + 0.004 * std::sin(80 * x.x()), 1.2 * x.z()};
}
bool beyondPlane(const Vector3d& x) {
  return x.x() > 0.003;
}
double height(const Vector3d& x) {
  return x.x() + 0.4 * x.y() - 0.0123;
}

/// A cloth, a block, a cloth that cannot be cut, a ball with partial cells: only the first body's indices begin at 0.
class HostSurfaceTest : public ::testing::Test {
 protected:
  HostSurfaceTest() : rig_(bodies()), host_(rig_.model) { snapshot_.bricks = host_.shownBricks(); }

  void cut() {
    cutThrough(rig_, 0, height);
    for (const size_t b : {1, 3}) {
      std::vector<layout::NodeBits> nodes = rig_.ofBody(rig_.nodes, b);
      cutBetween(rig_.model.bodies[b].lattice, beyondPlane, nodes);
      std::copy(nodes.begin(), nodes.end(), rig_.nodes.begin() + rig_.model.slotOffset(b));
    }
  }
  VisibleMesh onHost() {
    snapshot_.displacement_m.clear();
    for (const uint32_t brick : snapshot_.bricks) {
      const layout::vec4* const first = &rig_.displacement_m[size_t{layout::kBrickSlots} * brick];
      for (float layout::vec4::*component : {&layout::vec4::x, &layout::vec4::y, &layout::vec4::z}) {
        for (uint32_t i = 0; i < layout::kBrickSlots; ++i) snapshot_.displacement_m.push_back(first[i].*component);
      }
    }
    snapshot_.nodes = rig_.nodes;
    snapshot_.spring_cut = rig_.spring_cut;
    snapshot_.cut_revision = rig_.revision;
    VisibleMesh out;
    host_.show(snapshot_, out);
    return out;
  }
  void expectAsOnTheGpu() {
    rig_.follow();
    const VisibleMesh mesh = onHost();
    ASSERT_EQ(mesh.vertices(), rig_.surface.vertices());
    EXPECT_EQ(mesh.topology->triangles, rig_.surface.skin().shown(rig_.surface.alive().read().data())->triangles);
    const std::vector<Vector3d> positions = rig_.positions(), normals = rig_.normals();
    for (size_t v = 0; v < mesh.vertices(); ++v) {
      ASSERT_LT((mesh.position_m(v).cast<double>() - positions[v]).norm(), kPosition_m)
          << "vertex " << v << ": " << mesh.position_m(v).transpose() << " here, " << positions[v].transpose()
          << " on the GPU";
      ASSERT_LT((unpackNormal(mesh.normals[v]).cast<double>() - normals[v]).norm(), kNormalError) << "vertex " << v;
    }
  }

  gpu::Context context_;
  SurfaceRig rig_;
  HostSurface host_;
  StateSnapshot snapshot_;

 private:
  static std::vector<Body> bodies() {
    return {withNetworkSkin(clothBody(20, 17, 0.005)),
            makeBody(blockSolid({4, 3, 5}, kSpacing_m), boxMesh({0, 0, 0}, {0.04, 0.03, 0.05}, 9)),
            withNetworkSkin(clothBody(5, 6, 0.005), false), filledBallBody({0, 0, 0}, 0.025, kSpacing_m)};
  }
};

}  // namespace

TEST_F(HostSurfaceTest, RestIsTheMesh) {
  const VisibleMesh mesh = onHost();
  EXPECT_EQ(mesh.topology, host_.skin().whole());
  size_t vertex = 0;
  for (const Body& body : rig_.model.bodies) {
    for (size_t v = 0; v < body.skin.mesh.positions_m.size(); ++v) {
      ASSERT_LT((mesh.position_m(vertex + v) - body.skin.mesh.positions_m[v]).norm(), kPosition_m) << body.name << v;
    }
    vertex += body.skin.bindings.size() + 2 * body.skin.split_edges.size();
  }
  expectAsOnTheGpu();
}

TEST_F(HostSurfaceTest, FollowsNodesAsTheGpuDoes) {
  rig_.moveNodes(deformed);
  expectAsOnTheGpu();
}

TEST_F(HostSurfaceTest, SplitsAsTheGpuDoes) {
  rig_.moveNodes(deformed);
  cut();
  rig_.split();
  expectAsOnTheGpu();
  const VisibleMesh mesh = onHost();
  EXPECT_NE(mesh.topology->revision, host_.skin().whole()->revision);
  const std::vector<VisiblePatch>&now = mesh.topology->patches, &whole = host_.skin().whole()->patches;
  ASSERT_EQ(now.size(), 4u);
  EXPECT_GT(now[0].count, whole[0].count);  // in pieces
  for (size_t b = 1; b < now.size(); ++b) EXPECT_EQ(now[b].count, whole[b].count);
  EXPECT_EQ(onHost().topology, mesh.topology);
}

TEST_F(HostSurfaceTest, LooksAtSpringsOnlyWhereTheirRevisionIsAnotherOne) {
  cut();
  EXPECT_EQ(onHost().topology, host_.skin().whole());
  ++rig_.revision;
  EXPECT_NE(onHost().topology, host_.skin().whole());
}

TEST_F(HostSurfaceTest, ResetMakesItWhole) {
  const std::vector<layout::NodeBits> nodes = rig_.nodes;
  const std::vector<float> spring_cut = rig_.spring_cut;
  cut();
  rig_.split();
  EXPECT_NE(onHost().topology, host_.skin().whole());
  rig_.nodes = nodes;
  rig_.spring_cut = spring_cut;
  ++rig_.revision;
  host_.reset();
  rig_.surface.reset();
  EXPECT_EQ(onHost().topology, host_.skin().whole());
  expectAsOnTheGpu();
}

TEST_F(HostSurfaceTest, NormalsAreUnitForAnyInput) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const float value : {nan, inf, -inf, 1e38f, 1e-20f}) {
    for (layout::vec4& u : rig_.displacement_m) u = {value, 0, value, 0};
    const VisibleMesh mesh = onHost();
    for (const uint32_t packed : mesh.normals) ASSERT_NEAR(unpackNormal(packed).norm(), 1, kNormalError) << value;
  }
}
