// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/frustum.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace viscera {
namespace {

CameraConfig cameraAt(const Vector3d& position_m, const Vector3d& target_m) {
  CameraConfig camera;
  camera.position_m = position_m;
  camera.target_m = target_m;
  return camera;
}

bool isInPicture(const CameraConfig& camera, const Vector3f& point_m) {
  const Vector3f optical = (opticalPose(camera).inverse() * Vector3d(point_m.cast<double>())).cast<float>();
  const Eigen::Vector4f clip = clipFromOptical(camera) * optical.homogeneous();
  return clip.w() > 0 && clip.head<3>().cwiseAbs().maxCoeff() <= clip.w();
}

TEST(Frustum, NeverMissesABoxWithAPointInThePicture) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> position(-0.3F, 0.3F), size(0, 0.1F);
  const CameraConfig camera = cameraAt({0.1, -0.3, 0.1}, {0, 0.02, 0});
  const Frustum frustum(camera);
  int in_picture = 0, missed = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vector3f corner(position(random), position(random), position(random));
    const Eigen::AlignedBox3f box(corner, corner + Vector3f(size(random), size(random), size(random)));
    const bool seen = isInPicture(camera, box.sample());
    in_picture += seen;
    missed += frustum.misses(box);
    ASSERT_FALSE(seen && frustum.misses(box)) << box.center().transpose();
  }
  EXPECT_GT(in_picture, 1000);
  EXPECT_GT(missed, 5000);
}

TEST(Frustum, AnEmptyBoxIsMissedAndEverythingIsNot) {
  const Frustum frustum(cameraAt({0, -0.3, 0}, {0, 0, 0}));
  EXPECT_TRUE(frustum.misses(Eigen::AlignedBox3f()));
  constexpr float kMost = std::numeric_limits<float>::max();
  EXPECT_FALSE(frustum.misses({Vector3f::Constant(-kMost), Vector3f::Constant(kMost)}));
}

}  // namespace
}  // namespace viscera
