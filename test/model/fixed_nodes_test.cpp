// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
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
      if (!isFixed(lattice.nodes[slot])) highest_free = std::max(highest_free, at);
    }
    EXPECT_NEAR(lowest_fixed, z, kRounding);
    EXPECT_NEAR(highest_free, z - 0.01, kRounding);
    config.fixed[0].shape = FixedShape::kBox;  // the same by a box
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
    EXPECT_EQ(isFixed(lattice.nodes[slot]), in_front < 0.005) << in_front;
  }
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
