// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/mouse_aim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace viscera::rviz_plugin {
namespace {

constexpr double kEps_m = 1e-6;  // of positions in float32, within a metre

/// A square of 2 m at this height.
void send(SentSurface& surface, uint32_t version, float height_m) {
  SurfaceTopology topology;
  topology.version = version;
  topology.vertices = 4;
  topology.bodies = {"plate"};
  topology.body_triangles = {2};
  topology.wound_triangles = {0};
  topology.triangles = {0, 1, 2, 0, 2, 3};
  ASSERT_EQ(surface.take(topology), "");
  SurfaceVerticesPtr vertices(new SurfaceVertices);
  vertices->topology_version = version;
  vertices->positions_m = {-1, -1, height_m, 1, -1, height_m, 1, 1, height_m, -1, 1, height_m};
  vertices->normals.assign(4, 511U << 20U);
  ASSERT_EQ(surface.take(SurfaceVerticesConstPtr(vertices)), "");
}

/// From 1 m above, straight down.
ScreenRay down(double x) {
  return {{x, 0, 1}, -Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitY()};
}

TEST(MouseAim, TipIsSoFarBeforeTheSkinOrBehindIt) {
  SentSurface surface;
  MouseAim aim;
  EXPECT_FALSE(aim.at(down(0), surface, 0, 0, false));
  send(surface, 1, 0.25F);
  EXPECT_NEAR(aim.at(down(0.5), surface, -0.01, 0, false)->position_m.z(), 0.26, kEps_m);
  EXPECT_NEAR(aim.at(down(0.5), surface, 0.02, 0, false)->position_m.z(), 0.23, kEps_m);
  EXPECT_NEAR(aim.at(down(0.5), surface, 0.02, 0, false)->position_m.x(), 0.5, kEps_m);
}

TEST(MouseAim, BesideTheSkinItStaysAsFarAsItWas) {
  SentSurface surface;
  MouseAim aim;
  send(surface, 1, 0.25F);
  EXPECT_NEAR(aim.at(down(3), surface, -0.01, 0, false)->position_m.z(), 0.26, kEps_m) << "as far as the middle";
  send(surface, 2, 0.5F);
  aim.at(down(0), surface, -0.01, 0, false);
  EXPECT_NEAR(aim.at(down(3), surface, -0.01, 0, false)->position_m.z(), 0.51, kEps_m);
}

TEST(MouseAim, YieldingSkinIsNotFollowed) {
  SentSurface surface;
  MouseAim aim;
  send(surface, 1, 0.25F);
  aim.at(down(0), surface, -0.001, 0, false);
  aim.at(down(0), surface, 0.01, 0, false);
  send(surface, 2, 0.2F);  // the tip has pushed it
  EXPECT_NEAR(aim.at(down(0), surface, 0.01, 0, false)->position_m.z(), 0.24, kEps_m);
  EXPECT_NEAR(aim.at(down(0), surface, -0.01, 0, true)->position_m.z(), 0.26, kEps_m) << "a button is pressed";
  EXPECT_NEAR(aim.at(down(0), surface, -0.01, 0, false)->position_m.z(), 0.21, kEps_m) << "it is free again";
}

TEST(MouseAim, ShaftLeansFromTheLineOfSightToTheLowerRight) {
  SentSurface surface;
  MouseAim aim;
  send(surface, 1, 0);
  constexpr double kTilt = 0.7;
  const std::optional<Pose> pose = aim.at(down(0), surface, 0, kTilt, false);
  ASSERT_TRUE(pose);
  const Vector3d shaft = pose->orientation * Vector3d::UnitZ();
  const double part = std::sin(kTilt) / std::sqrt(2.0);
  EXPECT_NEAR((shaft - Vector3d(part, -part, std::cos(kTilt))).norm(), 0, kEps_m);
}

}  // namespace
}  // namespace viscera::rviz_plugin
