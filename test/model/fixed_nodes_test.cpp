// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <set>

#include "body_samples.h"

namespace viscera::test {
namespace {

constexpr double kRounding = 1e-9;  // m

std::set<std::array<double, 3>> fixedPositions(const Lattice& lattice) {
  std::set<std::array<double, 3>> fixed;
  for (const uint32_t slot : lattice.active_slots) {
    const Vector3d p = lattice.restPosition(slot);
    if (isFixed(lattice.nodes[slot])) fixed.insert({p.x(), p.y(), p.z()});
  }
  return fixed;
}

TEST(FixedNodes, FixedShapesAreInTheBodysFrame) {
  BodyConfig config = boxConfig({0.04, 0.04, 0.04}, 0.01);
  config.material.law = Law::kSprings;
  config.position_m = {0.5, -0.25, 0.125};
  FixedConfig plane;
  plane.shape = FixedShape::kPlane;
  plane.point_m = {0, 0, -0.02};
  plane.normal = {0, 0, 2};
  config.fixed = {plane};
  std::set<std::array<double, 3>> fixed = fixedPositions(build(config).lattice);
  EXPECT_EQ(fixed.size(), 25u) << "nodes right on the plane are held";
  for (const auto& p : fixed) EXPECT_NEAR(p[2], 0.105, kRounding);

  FixedConfig corner;
  corner.shape = FixedShape::kBox;
  corner.min_m = {0.005, 0.005, 0.005};
  corner.max_m = {0.02, 0.02, 0.02};
  FixedConfig middle;
  middle.shape = FixedShape::kSphere;
  middle.radius_m = 0.01;
  config.fixed = {corner, middle};
  fixed = fixedPositions(build(config).lattice);
  EXPECT_EQ(fixed.size(), 8u + 7u);

  config.rotation_deg = {0, 0, 180};
  config.fixed = {corner};
  for (const auto& p : fixedPositions(build(config).lattice)) {
    EXPECT_LT(p[0], 0.5);
    EXPECT_LT(p[1], -0.25);
    EXPECT_GT(p[2], 0.125);
  }
}

TEST(FixedNodes, APartIsFixedByItsName) {
  TriangleMesh two =
      joined(boxMesh({0, 0, 0}, {0.04f, 0.02f, 0.02f}), boxMesh({0.04f, 0, 0}, {0.06f, 0.02f, 0.02f}), false);
  two.part_names = {"muscle", "bone"};
  BodyConfig config = meshConfig(two, 0.01);
  FixedConfig bone;
  bone.shape = FixedShape::kPart;
  bone.part = "bone";
  config.fixed = {bone};
  const std::set<std::array<double, 3>> fixed = fixedPositions(build(config).lattice);
  EXPECT_EQ(fixed.size(), 27u) << "with the nodes that it shares with the muscle";
  for (const auto& p : fixed) EXPECT_GT(p[0], 0.04 - 1e-6);
  config.fixed[0].part = "tendon";
  const std::string message = errorOf<SceneError>(config);
  EXPECT_TRUE(contains(message, "body 'organ': fixed[0]: no part 'tendon'; the parts are muscle, bone")) << message;
}

FixedConfig planeAt(const Vector3d& point_m, const Vector3d& normal) {
  FixedConfig plane;
  plane.shape = FixedShape::kPlane;
  plane.point_m = point_m;
  plane.normal = normal;
  return plane;
}

TEST(FixedNodes, NodesOfAMeshLieOnThePlaneThatHoldsIt) {
  for (const double z : {0.0, 0.0123, 0.0277, 0.031}) {
    BodyConfig config = meshConfig(sphereMesh(Vector3f::Zero(), 0.04f, 24), 0.01);
    config.position_m = {0.1, 0.2, 0.3};
    config.fixed = {planeAt({0, 0, z}, {0, 0, -1})};
    const Lattice lattice = build(config).lattice;
    double lowest_fixed = 1, highest_free = -1;
    for (const uint32_t slot : lattice.active_slots) {
      const double at = lattice.restPosition(slot).z() - 0.3;
      if (isFixed(lattice.nodes[slot])) lowest_fixed = std::min(lowest_fixed, at);
      const bool in_tissue = (lattice.restPosition(slot) - config.position_m).norm() < 0.04;
      if (!isFixed(lattice.nodes[slot]) && in_tissue) highest_free = std::max(highest_free, at);
    }
    EXPECT_NEAR(lowest_fixed, z, kRounding);
    EXPECT_LT(highest_free, z - kRounding);    // nodes that no tissue reaches are free
    config.fixed[0].shape = FixedShape::kBox;  // the same with a box
    config.fixed[0].min_m = {-1, -1, z};
    config.fixed[0].max_m = {1, 1, 1};
    EXPECT_EQ(fixedPositions(build(config).lattice), fixedPositions(lattice));
  }
}

TEST(FixedNodes, NodesNearerThanHalfACellToASlopingPlaneAreHeld) {
  BodyConfig config = meshConfig(sphereMesh(Vector3f::Zero(), 0.04f, 24), 0.01);
  const Vector3d normal = Vector3d(1, 2, 3).normalized(), point(0.002, -0.01, 0.003);
  config.fixed = {planeAt(point, normal)};
  const Lattice lattice = build(config).lattice;
  for (const uint32_t slot : lattice.active_slots) {
    const double in_front = normal.dot(lattice.restPosition(slot) - point);
    const bool held = isFixed(lattice.nodes[slot]), in_tissue = lattice.restPosition(slot).norm() < 0.04;
    if (in_front >= 0.005 || in_tissue) {  // no tissue reaches the others
      EXPECT_EQ(held, in_front < 0.005) << in_front;
    }
  }
}

/// Near its pole a plane cuts a disc out of a ball: only nodes that it reaches are fixed, at most a cell's diagonal
/// farther out.
TEST(FixedNodes, OnlyNodesOfFacesThatTissueReachesAreHeld) {
  constexpr double kPlane_m = 0.036, kCell_m = 0.01;
  const double disc_m = std::sqrt(0.04 * 0.04 - kPlane_m * kPlane_m);
  BodyConfig config = meshConfig(sphereMesh(Vector3f::Zero(), 0.04f, 24), kCell_m);
  config.fixed = {planeAt({0, 0, -kPlane_m}, {0, 0, 1})};
  const std::set<std::array<double, 3>> held = fixedPositions(build(config).lattice);
  EXPECT_GT(held.size(), 4U);
  for (const std::array<double, 3>& at : held)
    EXPECT_LT(std::hypot(at[0], at[1]), disc_m + kCell_m * std::sqrt(2.0)) << at[0] << " " << at[1];
}

TEST(FixedNodes, AFixedShapeThatMatchesNothingIsRefused) {
  BodyConfig config = boxConfig({0.04, 0.04, 0.04}, 0.01);
  FixedConfig far;
  far.shape = FixedShape::kSphere;
  far.center_m = {1, 1, 1};
  config.fixed = {far};
  const std::string message = errorOf<SceneError>(config);
  EXPECT_TRUE(contains(message, "body 'slab': fixed[0] matches no node; the body spans")) << message;
}

TEST(FixedNodes, SceneInWhichNothingCanMoveIsRefused) {
  Scene scene;
  BodyConfig body;
  body.source = TissueSource::kBox;
  body.spacing_m = 0.01;
  FixedConfig everything;
  everything.shape = FixedShape::kSphere;
  everything.radius_m = 1;
  body.fixed = {everything};
  scene.bodies = {body};
  EXPECT_THROW(buildModel(scene), SceneError);
}

}  // namespace
}  // namespace viscera::test
