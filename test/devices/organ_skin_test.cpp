// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/organ_skin.h"

#include <gtest/gtest.h>

#include <cmath>

namespace viscera {
namespace {

constexpr double kFloat_m = 1e-7;  ///< of positions in single precision

/// Returns the faces of a box, two triangles each.
OrganSkin box(const Vector3d& low_m, const Vector3d& high_m) {
  OrganSkin out;
  for (int corner = 0; corner < 8; ++corner)
    for (int axis = 0; axis < 3; ++axis)
      out.points_m.push_back(static_cast<float>((corner >> axis & 1) ? high_m[axis] : low_m[axis]));
  out.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                   2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return out;
}

/// Returns the distance to a box about the origin: exact, outside and inside.
double distanceToBox(const Vector3d& half_m, const Vector3d& point_m) {
  const Vector3d beyond = point_m.cwiseAbs() - half_m;
  return beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

TEST(OrganSkin, DistanceIsThatOfTheSurfaceOnBothSides) {
  const Vector3d half(0.05, 0.02, 0.03);
  const OrganSkin skin = box(-half, half);
  for (double x : {-0.08, -0.05, -0.01, 0.0, 0.033, 0.06})
    for (double y : {-0.04, -0.015, 0.001, 0.021})
      for (double z : {-0.031, 0.0, 0.012, 0.09}) {
        const Vector3d point(x, y, z);
        EXPECT_NEAR(distanceToSkin(skin, point).value(), distanceToBox(half, point), kFloat_m) << point.transpose();
      }
}

TEST(OrganSkin, TrianglesThatNameNoVertexHaveNoDistance) {
  OrganSkin skin = box({0, 0, 0}, {1, 1, 1});
  EXPECT_FALSE(distanceToSkin(OrganSkin{}, Vector3d::Zero()));
  skin.triangles.push_back(0);
  EXPECT_FALSE(distanceToSkin(skin, Vector3d::Zero()));
  skin.triangles = {0, 1, 8};
  EXPECT_FALSE(distanceToSkin(skin, Vector3d::Zero()));
}

TEST(OrganSkin, ToolWaitsBeforeAnyOrganAndPointsAtItsMiddle) {
  for (double size : {0.05, 0.1, 0.2})
    for (const Vector3d& middle : {Vector3d(0, 0, 0), Vector3d(0.3, -0.2, 0.1)})
      for (const bool left : {true, false}) {
        const Vector3d half = size / 2 * Vector3d(1, 0.7, 0.4);
        // corners alone are too few for the surface around a line
        OrganSkin skin = box(middle - half, middle + half);
        for (int i = 0; i < 4000; ++i) {
          const Vector3d direction = Vector3d(std::sin(1.0 * i), std::sin(1.7 * i + 1), std::sin(2.3 * i + 2));
          const Vector3d at = middle + direction.cwiseProduct(half) / direction.cwiseAbs().maxCoeff();
          for (int axis = 0; axis < 3; ++axis) skin.points_m.push_back(static_cast<float>(at[axis]));
        }
        const Pose start = startBefore(skin, sideOfTool(left));
        const Vector3d away = start.position_m - middle;
        EXPECT_NEAR((start.orientation * Vector3d::UnitZ()).dot(away.normalized()), 1, kFloat_m);
        EXPECT_NEAR(start.orientation.norm(), 1, kFloat_m);
        EXPECT_GE(distanceToBox(half, away), 0.4 * kStartGap_m) << size;  // a face may be oblique to the line
        EXPECT_LT(away.norm(), half.norm() + kStartGap_m + kFloat_m);
        EXPECT_LT(away.y(), 0);  // in front of it, where the viewer is
        EXPECT_GT(away.z(), 0);
        EXPECT_EQ(away.x() < 0, left);
      }
}

TEST(OrganSkin, ToolWaitsBesideTheMiddleOfWhatIsNotThere) {
  EXPECT_NEAR(startBefore({}, {0, 0, 2}).position_m.z(), kStartGap_m, kFloat_m);
  EXPECT_NEAR((startBefore({}, {0, 0, 2}).orientation * Vector3d::UnitZ()).z(), 1, kFloat_m);
}

}  // namespace
}  // namespace viscera
