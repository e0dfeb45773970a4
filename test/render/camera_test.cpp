// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/render/camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "viscera/math/error.h"

using namespace viscera;

namespace {

constexpr double kTight = 1e-12;      // rounding of double arithmetic with numbers of order 1
constexpr double kFloatTight = 1e-5;  // rounding of float matrices, relative to numbers of order 1

CameraConfig lookingAlongY() {
  CameraConfig camera;
  camera.position_m = Vector3d(0, -0.3, 0);
  return camera;
}

Vector3d normalizedDevice(const CameraConfig& camera, const Vector3d& optical) {
  const Eigen::Vector4d clip = clipFromOptical(camera).cast<double>() * optical.homogeneous();
  return clip.hnormalized();
}

}  // namespace

TEST(Camera, OpticalFrameHasXRightYDownZForward) {
  const Pose pose = opticalPose(lookingAlongY());
  EXPECT_LT((pose.orientation * Vector3d::UnitX() - Vector3d::UnitX()).norm(), kTight);
  EXPECT_LT((pose.orientation * Vector3d::UnitY() + Vector3d::UnitZ()).norm(), kTight);
  EXPECT_LT((pose.orientation * Vector3d::UnitZ() - Vector3d::UnitY()).norm(), kTight);
}

/// A point ahead of the tip, on the axis of the shaft, as the handle turns about that axis. Image rows go down.
TEST(Camera, OfAnEndoscopeShowsAPointWhereItsLensAngleAndTheTurnOfItsHandlePutIt) {
  CameraConfig camera;
  camera.stylus = "scope";
  camera.lens_angle_deg = 30;
  const Intrinsics k = intrinsics(camera);
  const double aside_px = k.fy * std::tan(M_PI / 6);
  const Pose ahead{Vector3d(0.01, -0.1, 0.02), Quaterniond(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()))};
  const Vector3d point_m(0.01, -0.03, 0.02);
  const auto shown = [&](double turn_rad) {
    const Pose turned = ahead * Pose{Vector3d::Zero(), Quaterniond(Eigen::AngleAxisd(turn_rad, Vector3d::UnitZ()))};
    return pixelOf(camera, endoscopePose(camera, turned).inverse() * point_m).value();
  };
  EXPECT_LT((shown(0) - Eigen::Vector2d(k.cx, k.cy - aside_px)).norm(), 1e-9) << "looks down";
  EXPECT_LT((shown(M_PI / 2) - Eigen::Vector2d(k.cx - aside_px, k.cy)).norm(), 1e-9) << "looks right";
  EXPECT_LT((shown(M_PI) - Eigen::Vector2d(k.cx, k.cy + aside_px)).norm(), 1e-9) << "looks up, and up is up";
  camera.lens_angle_deg = 0;
  for (const double turn_rad : {0.0, 1.0, 3.0})
    EXPECT_LT((shown(turn_rad) - Eigen::Vector2d(k.cx, k.cy)).norm(), 1e-9) << "along the shaft";
  camera.up = Vector3d::UnitY();  // along the line of sight: y of the stylus is up
  EXPECT_LT((endoscopePose(camera, ahead).orientation * Vector3d::UnitY() + Vector3d::UnitZ()).norm(), kTight);
  camera.lens_angle_deg = 90;  // a level shaft that looks straight down: the way it points is up
  camera.up = Vector3d::UnitZ();
  EXPECT_LT((endoscopePose(camera, ahead).orientation * Vector3d::UnitZ() + Vector3d::UnitZ()).norm(), kTight);
  EXPECT_LT((endoscopePose(camera, ahead).orientation * Vector3d::UnitY() + Vector3d::UnitY()).norm(), kTight);
}

TEST(Camera, TargetIsSeenAtThePrincipalPoint) {
  CameraConfig camera;
  camera.position_m = Vector3d(0.3, 0.1, 0.7);
  camera.target_m = Vector3d(-0.1, 0.2, 0.05);
  const Vector3d optical = opticalPose(camera).inverse() * camera.target_m;
  EXPECT_NEAR(optical.x(), 0, kTight);
  EXPECT_NEAR(optical.y(), 0, kTight);
  EXPECT_NEAR(optical.z(), (camera.target_m - camera.position_m).norm(), kTight);
}

TEST(Camera, VerticalFieldOfViewSpansTheRows) {
  const CameraConfig camera = lookingAlongY();
  const Intrinsics k = intrinsics(camera);
  const double half_fov_rad = camera.vertical_fov_deg / 2 * M_PI / 180;
  EXPECT_NEAR(k.fy * std::tan(half_fov_rad) + k.cy, camera.height_px, 1e-9);
  EXPECT_EQ(k.fx, k.fy);
  EXPECT_EQ(k.cx, 320);
  EXPECT_EQ(k.cy, 240);
}

TEST(Camera, ClipCoordinatesAgreeWithTheIntrinsicsRowsFromTheTop) {
  const CameraConfig camera = lookingAlongY();
  const Intrinsics k = intrinsics(camera);
  const Vector3d optical(0.04, -0.03, 0.4);
  const Vector3d device = normalizedDevice(camera, optical);
  EXPECT_NEAR((device.x() + 1) / 2 * camera.width_px, k.fx * optical.x() / optical.z() + k.cx,
              kFloatTight * camera.width_px);
  EXPECT_NEAR((device.y() + 1) / 2 * camera.height_px, k.fy * optical.y() / optical.z() + k.cy,
              kFloatTight * camera.height_px);
}

TEST(Camera, NearAndFarPlanesFollowTheDistanceOfTheTarget) {
  const CameraConfig camera = lookingAlongY();
  const DepthRange range = depthRange(camera);
  EXPECT_NEAR(range.near_m, 0.003, kTight);
  EXPECT_NEAR(range.far_m, 30, 1e-9);
  EXPECT_NEAR(normalizedDevice(camera, Vector3d(0, 0, range.near_m)).z(), -1, kFloatTight);
  EXPECT_NEAR(normalizedDevice(camera, Vector3d(0, 0, range.far_m)).z(), 1, kFloatTight);
}

TEST(Camera, LinesOfSightAreThoseThatPixelsShow) {
  constexpr double kSame_px = 1e-8;
  CameraConfig camera = lookingAlongY();
  camera.vertical_fov_deg = 70;
  for (const PlumbBob& lens : {PlumbBob{}, PlumbBob{-0.2, 0.05, 0.003, -0.002, 0.001}, PlumbBob{0.1, 0, 0, 0, 0}}) {
    camera.distortion = lens;
    const CameraConfig pinhole = pinholeOf(camera);
    const Intrinsics k = intrinsics(camera), seen = intrinsics(pinhole);
    EXPECT_NEAR(seen.fx, k.fx, kSame_px);
    for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(0, 0), {640, 480}, {320, 240}, {17.5, 400.5}, {600.5, 3.5}}) {
      const Vector3d sight = lineOfSight(camera, pixel);
      const auto back = pixelOf(camera, 0.3 * sight);
      ASSERT_TRUE(back);
      EXPECT_LT((*back - pixel).norm(), kSame_px);
      EXPECT_LE(std::abs(seen.fx * sight.x()), 0.5 * pinhole.width_px + kSame_px);
      EXPECT_LE(std::abs(seen.fy * sight.y()), 0.5 * pinhole.height_px + kSame_px);
    }
  }
  EXPECT_FALSE(pixelOf(camera, Vector3d(0, 0, -1))) << "behind the camera";
}

TEST(Camera, AnImageThatFoldsOverHasNoLinesOfSightThere) {
  CameraConfig camera = lookingAlongY();
  camera.vertical_fov_deg = 90;
  camera.distortion.k1 = -0.4;  // at most 0.61 from the centre: r (1 - 0.4 r^2), at r = 0.91
  EXPECT_FALSE(undistorted(camera.distortion, {0.8, 0}));
  EXPECT_THROW(lineOfSight(camera, {0, 240}), SceneError);
  EXPECT_FALSE(pixelOf(camera, Vector3d(1.2, 0, 1))) << "shown where 0.5 is";
  EXPECT_TRUE(pixelOf(camera, Vector3d(0.5, 0, 1)));
}

TEST(Camera, CameraWithoutALineOfSightOrAnUprightIsRefusedByName) {
  CameraConfig at_target = lookingAlongY();
  at_target.name = "scope";
  at_target.target_m = at_target.position_m;
  CameraConfig no_upright = lookingAlongY();
  no_upright.name = "scope";
  no_upright.up = Vector3d(0, 2, 0);
  CameraConfig null_up = no_upright;
  null_up.up = Vector3d::Zero();
  for (const CameraConfig& camera : {at_target, no_upright, null_up}) {
    try {
      opticalPose(camera);
      FAIL() << "made a pose of nothing";
    } catch (const SceneError& e) {
      EXPECT_NE(std::string(e.what()).find("'scope'"), std::string::npos) << e.what();
    }
  }
}
