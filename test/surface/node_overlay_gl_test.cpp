// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/overlay/node_overlay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cloth_cuts.h"
#include "support/gpu_fixture.h"
#include "surface_rig.h"
#include "viscera/model/body/neighbors.h"

namespace viscera {
namespace {

using testing::SurfaceRig;

constexpr double kRounding = 5e-6;      // of a strain: roundings of displacements, of 1e-7 of 0.3 m, in lengths of 1 cm
constexpr double kPackedNormal = 2e-3;  // of a packed normal's direction: 1/511
constexpr double kNodeOverlaySpacing_m = 0.01;

class NodeOverlays : public test::GpuTest {
 protected:
  static Body ball() {
    const Vector3d center_m(0.1, -0.2, 0.3);
    const TriangleMesh mesh = testing::weldedSphereMesh(center_m, 0.04, 10);
    return testing::makeBody(voxelise(mesh, kNodeOverlaySpacing_m), mesh);
  }
};

size_t linesThatJoin(const std::vector<uint32_t>& indices, size_t count) {
  size_t lines = 0;
  for (size_t i = 0; i < count; i += 2) lines += indices[i] != indices[i + 1];
  return lines;
}

TEST_F(NodeOverlays, StrainIsTheRootMeanSquareOverTheSpringsOfANode) {
  SurfaceRig rig(ball());
  constexpr double kStretch = 0.2;
  rig.moveNodes([](const Vector3d& rest) { return Vector3d((1 + kStretch) * rest.x(), rest.y(), rest.z()); });
  rig.follow();
  NodeOverlay overlay(rig.model);
  overlay.follow(rig.state(), rig.surface);
  const std::vector<layout::vec4> nodes = overlay.nodes().read();
  const Lattice& lattice = rig.model.bodies[0].lattice;
  for (const uint32_t slot : lattice.active_slots) {
    double sum = 0, count = 0;
    for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
      if (springCount(lattice.nodes[slot], spring) == 0) continue;
      const std::array<int, 3>& to = kNeighborOffsets[spring];
      const Vector3d offset(to[0], to[1], to[2]);
      const Vector3d now((1 + kStretch) * offset.x(), offset.y(), offset.z());
      sum += std::pow(now.norm() / offset.norm() - 1, 2);
      ++count;
    }
    ASSERT_GT(count, 0);
    EXPECT_NEAR(nodes[slot].w, std::sqrt(sum / count), kRounding) << slot;
  }
}

TEST_F(NodeOverlays, CutSpringsAreNoLines) {
  SurfaceRig rig(ball());
  rig.follow();
  NodeOverlay overlay(rig.model);
  overlay.follow(rig.state(), rig.surface);
  const size_t count = overlay.makeLines(rig.state(), true), axial = overlay.makeLines(rig.state(), false);
  EXPECT_LT(axial, count);
  overlay.makeLines(rig.state(), true);
  const size_t before = linesThatJoin(overlay.lines().read(), count);
  EXPECT_EQ(before, count / 2);
  const uint32_t slot = rig.model.bodies[0].skin.bound_slots[7];
  size_t lost = 0;
  for (const uint32_t spring : {0U, 2U, 6U}) {
    const int64_t other = rig.model.bodies[0].lattice.neighborSlot(slot, spring);
    const std::vector<uint32_t>& bound = rig.model.bodies[0].skin.bound_slots;
    lost += other >= 0 && std::binary_search(bound.begin(), bound.end(), static_cast<uint32_t>(other)) &&
            springCount(rig.nodes[slot], spring) != 0;
    setSpringCount(rig.nodes[slot], spring, 0);
  }
  ASSERT_GT(lost, 0U);
  rig.upload();
  overlay.follow(rig.state(), rig.surface);
  overlay.makeLines(rig.state(), true);
  EXPECT_EQ(linesThatJoin(overlay.lines().read(), count), before - lost);
}

TEST_F(NodeOverlays, NormalsStandOnTheBallAndPointAwayFromItsMiddle) {
  SurfaceRig rig(ball());
  rig.follow();
  NodeOverlay overlay(rig.model);
  overlay.follow(rig.state(), rig.surface);
  overlay.makeNormals(rig.state(), rig.surface);
  const std::vector<layout::vec4> ends = overlay.normals().read();
  ASSERT_EQ(ends.size(), 2 * rig.model.bodies[0].skin.bound_slots.size());
  for (size_t i = 0; i < ends.size(); i += 2) {
    const Vector3d from(ends[i].x, ends[i].y, ends[i].z), to(ends[i + 1].x, ends[i + 1].y, ends[i + 1].z);
    const Vector3d rest = restPosition(rig.model.bodies[0], rig.model.bodies[0].skin.bound_slots[i / 2]);
    EXPECT_LT((from - rest).norm(), 1e-7);
    EXPECT_GE((to - from).dot(from - Vector3d(0.1, -0.2, 0.3)), 0);
    EXPECT_LT((to - from).norm(), 0.6001 * kNodeOverlaySpacing_m);
  }
}

TEST_F(NodeOverlays, WhatCamerasShareIsWorkedOutOnceOfAState) {
  SurfaceRig rig(ball());
  rig.follow();
  NodeOverlay overlay(rig.model);
  overlay.follow(rig.state(), rig.surface);
  const size_t all = overlay.makeLines(rig.state(), true);
  const std::vector<uint32_t> lines = overlay.lines().read();
  for (layout::NodeBits& bits : rig.nodes) bits.lo &= ~layout::kAxialMask;  // would give other lines
  rig.upload();
  EXPECT_LT(overlay.makeLines(rig.state(), false), all);
  EXPECT_EQ(overlay.makeLines(rig.state(), true), all);
  EXPECT_EQ(overlay.lines().read(), lines);
  overlay.makeColors(rig.surface, 0.1);
  const std::vector<uint32_t> colors = overlay.colors().read();
  rig.moveNodes([](const Vector3d& rest) { return Vector3d(1.05 * rest); });
  rig.follow();
  overlay.makeColors(rig.surface, 0.1);
  EXPECT_EQ(overlay.colors().read(), colors);
  overlay.follow(rig.state(), rig.surface);
  overlay.makeLines(rig.state(), true);
  EXPECT_NE(overlay.lines().read(), lines);
  overlay.makeColors(rig.surface, 0.1);
  EXPECT_NE(overlay.colors().read(), colors);
}

TEST_F(NodeOverlays, AClothIsShownWithItsStrainAndTheLinksThatAreLeft) {
  SurfaceRig rig(testing::withNetworkSkin(test::clothBody(6, 7, kNodeOverlaySpacing_m)));
  rig.moveNodes([](const Vector3d& rest) { return Vector3d(1.1 * rest); });
  rig.follow();
  NodeOverlay overlay(rig.model);
  overlay.follow(rig.state(), rig.surface);
  const std::vector<layout::vec4> nodes = overlay.nodes().read();
  for (const uint32_t slot : rig.model.bodies[0].lattice.active_slots)
    EXPECT_NEAR(nodes[slot].w, 0.1, kRounding) << slot;  // rest length at the distance of their ends: 1.1 times as long
  const size_t count = overlay.makeLines(rig.state(), true);
  EXPECT_EQ(linesThatJoin(overlay.lines().read(), count), rig.model.bodies[0].network->springs.size());
  rig.spring_cut[3] = 0.5F;
  rig.upload();
  overlay.follow(rig.state(), rig.surface);
  overlay.makeLines(rig.state(), true);
  EXPECT_EQ(linesThatJoin(overlay.lines().read(), count), rig.model.bodies[0].network->springs.size() - 1);
  overlay.makeNormals(rig.state(), rig.surface);
  const std::vector<layout::vec4> ends = overlay.normals().read();
  const std::vector<Vector3d> normals = rig.normals();
  for (size_t v = 0; v < rig.model.bodies[0].skin.bindings.size(); ++v) {
    const Vector3d spike(ends[2 * v + 1].x - ends[2 * v].x, ends[2 * v + 1].y - ends[2 * v].y,
                         ends[2 * v + 1].z - ends[2 * v].z);
    EXPECT_LT((spike.normalized() - normals[v].normalized()).norm(), kPackedNormal) << v;
  }
}

}  // namespace
}  // namespace viscera
