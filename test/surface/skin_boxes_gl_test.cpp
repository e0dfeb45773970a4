// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/skin_boxes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/networks.h"
#include "surface/surface_rig.h"
#include "viscera/gpu/context.h"

using namespace viscera;
using namespace viscera::testing;

namespace {

constexpr double kSkinBoxesSpacing_m = 0.01, kSkinBoxesRadius_m = 0.05;

Body ballOf(Mapping mapping, bool partial) {
  const Vector3d center_m(0.01, 0.02, 0.03);
  const TriangleMesh mesh = weldedSphereMesh(center_m, partial ? kSkinBoxesRadius_m : 1.1 * kSkinBoxesRadius_m, 10);
  const Solid solid = partial ? voxeliseByMoments(mesh, kSkinBoxesSpacing_m)
                              : ballSolid(center_m, kSkinBoxesRadius_m, kSkinBoxesSpacing_m);
  Body body;
  body.lattice = buildLattice(solid, Weights::kCell);
  body.skin = bindSkin(mesh, body.lattice, solid, mapping);
  return body;
}

/// Returns a crumpled position: neighbours are moved in different directions.
Vector3d crumpled(const Vector3d& x) {
  const auto wave = [&](double a, double b, double c) { return 0.02 * std::sin(a * x.x() + b * x.y() + c * x.z()); };
  return 1.5 * x + Vector3d(wave(300, 50, 20), wave(10, 400, 80), wave(90, 30, 350)) + Vector3d(0.3, 0, 0);
}

class SkinBoxesTest : public ::testing::Test {
 protected:
  static std::vector<SkinBox> boxesOf(const SurfaceRig& rig) {
    return rig.surface.boxes().place(HostDisplacements::ofSlots(rig.displacement_m));
  }
  /// Expects every vertex inside the box of its body.
  static void expectInside(SurfaceRig& rig) {
    rig.follow();
    const std::vector<SkinBox> boxes = boxesOf(rig);
    const std::vector<Vector3d> positions = rig.positions();
    ASSERT_GT(positions.size(), 0U);
    for (size_t v = 0; v < positions.size(); ++v)
      ASSERT_TRUE(boxes.at(0).contains(positions[v].cast<float>())) << "vertex " << v;
  }
  gpu::Context context_;
};

TEST_F(SkinBoxesTest, VerticesLieInTheBoxOfTheirBody) {
  for (const Mapping mapping :
       {Mapping::kAuto, Mapping::kOneToOne, Mapping::kConstant, Mapping::kInterpolated, Mapping::kAlongNormal}) {
    for (const bool partial : {false, true}) {
      SCOPED_TRACE(static_cast<int>(mapping) * 2 + static_cast<int>(partial));
      SurfaceRig rig(ballOf(mapping, partial));
      expectInside(rig);
      rig.moveNodes(crumpled);
      expectInside(rig);
    }
  }
}

TEST_F(SkinBoxesTest, BoxesAreNotMuchLargerThanWhatTheyHold) {
  const SurfaceRig rig(ballOf(Mapping::kConstant, false));
  constexpr double kLargest_m = 2 * (1.1 * kSkinBoxesRadius_m + 2 * kSkinBoxesSpacing_m);  // mesh, nodes, offsets
  EXPECT_LT(boxesOf(rig).at(0).sizes().maxCoeff(), kLargest_m);
}

TEST_F(SkinBoxesTest, WhatIsNotANumberIsEverywhere) {
  SurfaceRig rig(ballOf(Mapping::kConstant, false));
  for (layout::vec4& u : rig.displacement_m) u.y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(boxesOf(rig).at(0).contains(Vector3f(100, -100, 100)));
}

TEST_F(SkinBoxesTest, OnlyBodiesThatAreAskedForAreMappedAndDrawn) {
  const auto bodies = [] {
    return std::vector<Body>{ballOf(Mapping::kInterpolated, false), ballOf(Mapping::kAuto, true),
                             ballOf(Mapping::kInterpolated, false)};
  };
  SurfaceRig rig(bodies()), all(bodies());
  for (SurfaceRig* each : {&rig, &all}) {
    each->follow();
    each->moveNodes(crumpled);
  }
  all.follow();
  const std::vector<Vector3d> before = rig.positions(), after = all.positions();
  const std::vector<uint32_t> normals = all.surface.normals().read();
  const std::vector<uint8_t> asked = {1, 0, 1};
  rig.upload();
  rig.surface.follow(rig.state(), &asked);
  const std::vector<Vector3d> now = rig.positions();
  const std::vector<uint32_t> now_normals = rig.surface.normals().read();
  const size_t second = rig.model.bodies[0].skin.bindings.size();
  const size_t third = second + rig.model.bodies[1].skin.bindings.size();
  for (size_t v = 0; v < now.size(); ++v) {
    const bool is_asked = v < second || v >= third;
    ASSERT_EQ(now[v], is_asked ? after[v] : before[v]) << "vertex " << v;
    if (is_asked) {
      ASSERT_EQ(now_normals[v], normals[v]) << "vertex " << v;
    }
  }
  const IndexRuns runs = rig.surface.runsOf(asked), whole = rig.surface.runsOf({1, 1, 1});
  const auto indices = [&](size_t b) { return 3 * rig.model.bodies[b].skin.mesh.triangles.size(); };
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].first, 0U);
  EXPECT_EQ(runs[0].count, indices(0));
  EXPECT_EQ(runs[1].first, indices(0) + indices(1));
  EXPECT_EQ(runs[1].count, indices(2));
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_EQ(whole[0].count, rig.surface.liveCount());
}

}  // namespace
