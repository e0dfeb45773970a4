// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/skin_groups.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/networks.h"
#include "surface/surface_rig.h"
#include "viscera/gpu/context.h"

using namespace viscera;
using namespace viscera::testing;

namespace {

constexpr double kSpacing_m = 0.01, kRadius_m = 0.05;

Body ballOf(Mapping mapping, bool partial) {
  const Vector3d center_m(0.01, 0.02, 0.03);
  const TriangleMesh mesh = weldedSphereMesh(center_m, partial ? kRadius_m : 1.1 * kRadius_m, 10);
  const Solid solid = partial ? voxeliseByMoments(mesh, kSpacing_m) : ballSolid(center_m, kRadius_m, kSpacing_m);
  Body body;
  body.lattice = buildLattice(solid, Weights::kCell);
  body.skin = bindSkin(mesh, body.lattice, solid, mapping);
  return body;
}

/// Crumpled: nothing is where its neighbours are.
Vector3d crumpled(const Vector3d& x) {
  const auto wave = [&](double a, double b, double c) { return 0.02 * std::sin(a * x.x() + b * x.y() + c * x.z()); };
  return 1.5 * x + Vector3d(wave(300, 50, 20), wave(10, 400, 80), wave(90, 30, 350)) + Vector3d(0.3, 0, 0);
}

class SkinGroupsTest : public ::testing::Test {
 protected:
  /// Every triangle lies in the box of its group.
  static void expectInside(SurfaceRig& rig) {
    rig.follow();
    const SkinGroups& groups = rig.surface.groups();
    std::vector<SkinBox> boxes;
    groups.place(HostDisplacements::ofSlots(rig.displacement_m), boxes);
    const std::vector<Vector3d> positions = rig.positions();
    const std::vector<uint32_t>& indices = rig.surface.skin().indices();
    ASSERT_GT(indices.size(), 0U);
    for (size_t i = 0; i < indices.size(); ++i) {
      const SkinBox& box = boxes[groups.groupOfVertex(indices[i - i % 3])];
      ASSERT_TRUE(box.contains(positions[indices[i]].cast<float>())) << "corner " << i;
    }
  }
  gpu::Context context_;
};

TEST_F(SkinGroupsTest, TrianglesLieInTheBoxOfTheirGroup) {
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

TEST_F(SkinGroupsTest, BoxesAreNotMuchLargerThanWhatTheyHold) {
  SurfaceRig rig(ballOf(Mapping::kConstant, false));
  const SkinGroups& groups = rig.surface.groups();
  EXPECT_GT(groups.count(), 8U);
  std::vector<SkinBox> boxes;
  groups.place(HostDisplacements::ofSlots(rig.displacement_m), boxes);
  constexpr float kLargest_m = 9 * static_cast<float>(kSpacing_m);  // a brick of four, its neighbours', and offsets
  for (size_t g = 0; g < groups.count(); ++g) {
    if (!groups.hasTriangles(g)) continue;
    EXPECT_LT(boxes[g].sizes().maxCoeff(), kLargest_m);
  }
}

TEST_F(SkinGroupsTest, WhatIsNotANumberIsEverywhere) {
  SurfaceRig rig(ballOf(Mapping::kConstant, false));
  for (layout::vec4& u : rig.displacement_m) u.y = std::numeric_limits<float>::quiet_NaN();
  std::vector<SkinBox> boxes;
  rig.surface.groups().place(HostDisplacements::ofSlots(rig.displacement_m), boxes);
  for (size_t g = 0; g < boxes.size(); ++g) {
    if (!rig.surface.groups().hasTriangles(g)) continue;
    EXPECT_TRUE(boxes[g].contains(Vector3f(100, -100, 100)));
  }
}

TEST_F(SkinGroupsTest, OnlyWhatIsNeededIsMapped) {
  SurfaceRig rig(ballOf(Mapping::kInterpolated, false)), all(ballOf(Mapping::kInterpolated, false));
  for (SurfaceRig* each : {&rig, &all}) {
    each->follow();
    each->moveNodes(crumpled);
  }
  all.follow();
  const SkinGroups& groups = rig.surface.groups();
  const std::vector<Vector3d> before = rig.positions(), after = all.positions();
  const std::vector<uint32_t> normals = all.surface.normals().read();
  std::vector<uint8_t> shown(groups.count());
  const uint32_t group = groups.groupOfVertex(rig.surface.skin().indices()[0]);
  shown[group] = 1;
  SkinGroups::Needs needs;
  groups.need(shown, needs);
  rig.upload();
  rig.surface.follow(rig.state(), &needs);
  const std::vector<uint32_t>& indices = rig.surface.skin().indices();
  const std::vector<Vector3d> now = rig.positions();
  for (size_t i = 0; i < indices.size(); ++i) {
    if (groups.groupOfVertex(indices[i - i % 3]) != group) continue;
    EXPECT_EQ(now[indices[i]], after[indices[i]]);
    EXPECT_EQ(rig.surface.normals().read()[indices[i]], normals[indices[i]]);
  }
  size_t left = 0;
  for (size_t v = 0; v < now.size(); ++v) left += now[v] == before[v] ? 1 : 0;
  EXPECT_GT(left, now.size() / 2);
}

}  // namespace
