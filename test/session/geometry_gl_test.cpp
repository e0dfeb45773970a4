// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Depths, labels and pairs of images give positions: against a block, a ball and tools at known positions.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "session/on_backends.h"
#include "viscera/layout/picture_labels.h"
#include "viscera/render/camera.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kAwayM = 0.25;   ///< of the camera from the middle of the block
constexpr double kDepthM = 2e-6;  ///< float32 at a quarter of a metre, through two matrices
/// Rasterisers put vertices on a grid of 1/256 pixel; a pixel is 1.1 mm here. Half of that, on a face seen at 60
/// degrees, plus kDepthM.
constexpr double kSnappedM = 6e-6;
constexpr double kFlatM = 3e-4;  ///< between a round shape and the flat faces with which it is drawn
constexpr double kBaselineM = 0.01;

class Geometry : public OnSceneBackend {
 protected:
  /// Returns a scene with a camera directly in front of the block's front face, y = -kHalfM.
  static Scene scene() {
    Scene scene = OnSceneBackend::scene();
    CameraConfig& camera = scene.cameras[0];
    camera.position_m = Vector3d(0, -kAwayM, 0);
    camera.width_px = 160;
    camera.height_px = 120;
    return scene;
  }
  /// Returns the position shown by a pixel, tissue frame.
  static Vector3d positionOf(const CameraConfig& camera, const ImageFrame& depths, size_t pixel) {
    const auto width = static_cast<size_t>(depths.width);
    const Eigen::Vector2d at(static_cast<double>(pixel % width) + 0.5, static_cast<double>(pixel / width) + 0.5);
    return opticalPose(camera) * (depths.depths_m[pixel] * lineOfSight(camera, at));
  }
  static size_t middle(const ImageFrame& image) {
    return static_cast<size_t>(image.height / 2 * image.width + image.width / 2);
  }
};
VISCERA_ON_EVERY_BACKEND(Geometry);

TEST_P(Geometry, DepthIsThatOfTheFaceBeforeTheCameraAndNothingIsInfinitelyFar) {
  Session session(scene(), context_);
  const ImageFrame depths = picture(session, PictureKind::kDepth);
  ASSERT_EQ(depths.depths_m.size(), size_t{160} * 120);
  EXPECT_TRUE(depths.rgb.empty());
  EXPECT_NEAR(depths.depths_m[middle(depths)], kAwayM - kHalfM, kDepthM);
  EXPECT_EQ(depths.depths_m[0], std::numeric_limits<float>::infinity());
}

TEST_P(Geometry, PixelsLieOnTheSurfaceWhereCameraInfoPutsThem) {
  Scene oblique = scene();
  oblique.cameras[0].position_m = Vector3d(0.1, -0.15, 0.12);
  Session session(oblique, context_);
  const ImageFrame depths = picture(session, PictureKind::kDepth), labels = picture(session, PictureKind::kLabels);
  size_t on_block = 0;
  for (size_t i = 0; i < labels.labels.size(); ++i) {
    ASSERT_EQ(labels.labels[i] == 0, std::isinf(depths.depths_m[i]));
    if (labels.labels[i] == 0) continue;
    ASSERT_EQ(labels.labels[i], layout::kFirstBodyLabel);
    ++on_block;
    ASSERT_NEAR(positionOf(oblique.cameras[0], depths, i).cwiseAbs().maxCoeff(), kHalfM, kSnappedM) << i;
  }
  EXPECT_GT(on_block, 500U);
}

TEST_P(Geometry, ThroughALensPixelsLieOnTheSurfaceToo) {
  constexpr double kAtEdges_m = 0.002;  // of half a pixel, 1.2 mm: next to an edge a depth is that of the nearest one
  constexpr double kBeside_m = 0.006;   // from an edge of the block: two pixels of 1.2 mm, on a face seen at 27 degrees
  Scene bent = scene();
  bent.cameras[0].position_m = Vector3d(0.05, -0.08, 0.06);
  bent.cameras[0].vertical_fov_deg = 70;
  bent.cameras[0].distortion = {-0.2, 0.05, 0.003, -0.002, 0};
  Session session(bent, context_);
  const ImageFrame depths = picture(session, PictureKind::kDepth), labels = picture(session, PictureKind::kLabels);
  ASSERT_EQ(labels.labels.size(), size_t{160} * 120);
  size_t within = 0;
  for (size_t i = 0; i < labels.labels.size(); ++i) {
    ASSERT_EQ(labels.labels[i] == 0, std::isinf(depths.depths_m[i]));
    if (labels.labels[i] == 0) continue;
    Vector3d position = positionOf(bent.cameras[0], depths, i).cwiseAbs();
    std::sort(position.begin(), position.end());
    const bool beside_edge = position[1] > kHalfM - kBeside_m;
    within += beside_edge ? 0 : 1;
    ASSERT_NEAR(position[2], kHalfM, beside_edge ? kAtEdges_m : kSnappedM) << i;
  }
  EXPECT_GT(within, 500U);
}

TEST_P(Geometry, LabelsDistinguishBodiesWallsToolsAndObstacles) {
  Scene with_ball = scene();
  with_ball.cameras[0].position_m = Vector3d(0, -0.12, 0.15);
  ObstacleConfig ball;
  ball.shape = ObstacleShape::kSphere;
  ball.position_m = Vector3d(0.06, 0, 0);
  ball.radius_m = 0.01;
  with_ball.obstacles = {ball};
  Session session(with_ball, context_);
  play(session, cut, kCutTicks);
  play(
      session,
      [](int tick) {
        return leftAt({-0.03, 0.0, kHalfM + 0.002 * tick});
      },
      5);  // the probe, next to it
  session.drain();
  const ImageFrame labels = picture(session, PictureKind::kLabels), depths = picture(session, PictureKind::kDepth);
  const std::set<int> seen(labels.labels.begin(), labels.labels.end());
  const int body = layout::kFirstBodyLabel, tool = layout::kFirstToolLabel, obstacle = layout::kFirstObstacleLabel;
  EXPECT_TRUE(seen.count(0) && seen.count(body) && seen.count(tool) && seen.count(obstacle));
  for (size_t i = 0; i < labels.labels.size(); ++i) {
    if (labels.labels[i] != obstacle) continue;
    ASSERT_NEAR((positionOf(with_ball.cameras[0], depths, i) - ball.position_m).norm(), ball.radius_m, kFlatM);
  }
}

TEST_P(Geometry, DepthsOfRoundObstaclesAreThoseOfTheShapeUpToItsRim) {
  constexpr double kRound_m = 5e-5;  // of float rays at 0.3 m, next to a rim
  constexpr double kRim_px = 0.02;   // share of pixels: a rim of one pixel is a thirtieth
  Scene round = scene();
  round.bodies[0].box_size_m = Vector3d::Constant(0.004);  // out of the view
  round.bodies[0].spacing_m = 0.001;
  round.bodies[0].fixed = {};
  round.styluses.clear();
  ObstacleConfig ball, capsule;
  ball.shape = ObstacleShape::kSphere;
  ball.position_m = Vector3d(0.03, 0, 0.02);
  ball.radius_m = 0.025;
  capsule.shape = ObstacleShape::kCapsule;
  capsule.position_m = Vector3d(-0.03, 0, 0);
  capsule.rotation_deg = Vector3d(30, 20, 0);
  capsule.radius_m = 0.012;
  capsule.length_m = 0.04;
  round.obstacles = {ball, capsule};
  Session session(round, context_);
  const ImageFrame labels = picture(session, PictureKind::kLabels), depths = picture(session, PictureKind::kDepth);
  const Vector3d axis = rotationFromDegrees(capsule.rotation_deg) * Vector3d::UnitZ();
  size_t on_ball = 0, on_capsule = 0;
  for (size_t i = 0; i < labels.labels.size(); ++i) {
    const int obstacle = labels.labels[i] - static_cast<int>(layout::kFirstObstacleLabel);
    if (obstacle < 0) continue;
    const Vector3d at =
        positionOf(round.cameras[0], depths, i) - round.obstacles[static_cast<size_t>(obstacle)].position_m;
    const double along = std::clamp(at.dot(axis), -0.5 * capsule.length_m, 0.5 * capsule.length_m);
    if (obstacle == 0) {
      ++on_ball;
      ASSERT_NEAR(at.norm(), ball.radius_m, kRound_m) << i;
    } else {
      ++on_capsule;
      ASSERT_NEAR((at - along * axis).norm(), capsule.radius_m, kRound_m) << i;
    }
  }
  EXPECT_GT(on_capsule, 100U);
  // As many pixels as the cone of rays tangent to the ball contains: none is missing at its rim.
  size_t wanted = 0;
  ImageFrame unit = depths;
  std::fill(unit.depths_m.begin(), unit.depths_m.end(), 1.0F);
  const Vector3d eye = round.cameras[0].position_m;
  for (size_t i = 0; i < labels.labels.size(); ++i) {
    const Vector3d offset = (positionOf(round.cameras[0], unit, i) - eye).normalized();
    const Vector3d to = ball.position_m - eye;
    wanted += (to - to.dot(offset) * offset).norm() < ball.radius_m;
  }
  EXPECT_NEAR(static_cast<double>(on_ball), static_cast<double>(wanted), kRim_px * static_cast<double>(wanted));
}

TEST_P(Geometry, WallsOfAWoundHaveALabelOfTheirOwn) {
  Scene pulled = scene();
  pulled.cameras[0].position_m = Vector3d(0.01, -0.01, 0.15);
  pulled.styluses[1].idle = ToolMode::kGrab;
  Session session(pulled, context_);
  play(session, cut, kCutTicks);
  play(
      session,
      [](int tick) {  // the lip beyond the cut is drawn away
        StylusSamples samples;
        samples[1] = {true, {Vector3d(0, 0.008 + 0.001 * tick, kHalfM), Quaterniond::Identity()}, false, false};
        return samples;
      },
      10);
  session.drain();
  const ImageFrame labels = picture(session, PictureKind::kLabels);
  EXPECT_GT(std::count(labels.labels.begin(), labels.labels.end(), layout::kFirstWallLabel), 10);
}

double meanDrawnColumn(const ImageFrame& image) {
  double sum = 0, count = 0;
  for (size_t i = 0; i < image.rgb.size() / 3; ++i) {
    if (std::equal(&image.rgb[3 * i], &image.rgb[3 * i] + 3, image.rgb.data())) continue;  // the corner is background
    sum += static_cast<double>(i % static_cast<size_t>(image.width));
    count += 1;
  }
  return sum / count;
}

TEST_P(Geometry, TheRightPictureIsShiftedByTheDisparity) {
  Scene stereo = scene();
  stereo.cameras[0].stereo_baseline_m = kBaselineM;  // inside the face, so no side comes into view
  Session session(stereo, context_);
  const double left = meanDrawnColumn(picture(session, PictureKind::kColor)),
               right = meanDrawnColumn(picture(session, PictureKind::kRight));
  const double disparity = intrinsics(stereo.cameras[0]).fx * kBaselineM / (kAwayM - kHalfM);
  EXPECT_GT(disparity, 3);
  EXPECT_NEAR(left - right, disparity, 1);
}

TEST_P(Geometry, OnlyWhatIsWantedIsDrawnAndAStillPictureOnce) {
  Scene stereo = scene();
  stereo.cameras[0].stereo_baseline_m = kBaselineM;
  Session session(stereo, context_);
  picture(session, PictureKind::kDepth);
  EXPECT_EQ(session.counters().renders, 1U);
  EXPECT_EQ(session.counters().readbacks, 1U);
  FrameRequest all;
  all.cameras = all.right = all.depth = all.labels = {true};
  EXPECT_EQ(session.show(all).images.size(), 4U);
  EXPECT_EQ(session.counters().readbacks, 5U);
  EXPECT_LE(session.counters().renders, 4U);  // left and right, and depths with labels at most once more
}

/// A camera carried to a position shows the same as one placed there.
TEST_P(Geometry, ACarriedCameraSeesWhatOneThatStandsThereSees) {
  const Vector3d away(0.125, -0.03125, 0.0625);  // exact in binary: no rounding
  Scene carried = scene(), standing = scene();
  carried.cameras[0].frame = "scope";
  standing.cameras[0].position_m += away;
  standing.cameras[0].target_m += away;
  ImageFrame after;
  {
    Session moving(carried, context_);
    const ImageFrame before = picture(moving, PictureKind::kColor);
    moving.setCameraFrame(0, {away, Quaterniond::Identity()});
    after = picture(moving, PictureKind::kColor);
    EXPECT_NE(before.rgb, after.rgb);
  }
  Session fixed(standing, context_);
  EXPECT_EQ(after.rgb, picture(fixed, PictureKind::kColor).rgb);
}

TEST_P(Geometry, AnOpticalFrameIsTheCameraItself) {
  Scene carried = scene(), standing = scene();
  carried.cameras[0].frame = "scope_optical";
  carried.cameras[0].position_m = Vector3d(kAwayM, 0, 0);  // only its distance is used
  ImageFrame seen;
  {
    Session moving(carried, context_);
    moving.setCameraFrame(0, opticalPose(standing.cameras[0]));
    seen = picture(moving, PictureKind::kColor);
  }
  Session fixed(standing, context_);
  EXPECT_EQ(seen.rgb, picture(fixed, PictureKind::kColor).rgb);
}

/// An endoscope through a trocar, at three poses: its pixels lie on the block where its own pose puts them, and it does
/// not show itself.
TEST_P(Geometry, ThroughAnEndoscopePixelsLieOnTheSurfaceToo) {
  Scene inside = scene();
  StylusConfig& scope = inside.styluses[0];
  scope.idle = ToolMode::kNone;
  scope.shaft_length_m = 0.3;
  scope.trocar = {TrocarMotion::kTip, Vector3d(0, -0.15, 0.03)};
  inside.cameras[0].stylus = scope.name;
  inside.cameras[0].lens_angle_deg = 30;
  Session session(inside, context_);
  for (const Vector3d& tip_m : {Vector3d(0, -0.1, 0.03), Vector3d(0.02, -0.09, 0.02), Vector3d(-0.01, -0.07, 0.05)}) {
    StylusSamples samples{};
    samples[0] = {true, {tip_m, Quaterniond(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()))}, false, false};
    const Frame frame = session.step(samples, {});
    const Pose optical = frame.cameras[0];
    EXPECT_LT((optical.position_m - tip_m).norm(), 1e-12);
    const Vector3d shaft = (optical.position_m - scope.trocar.position_m).normalized();
    EXPECT_NEAR(shaft.dot(optical.orientation * Vector3d::UnitZ()), std::cos(M_PI / 6), 1e-9);
    const ImageFrame depths = picture(session, PictureKind::kDepth), labels = picture(session, PictureKind::kLabels);
    size_t on_block = 0;
    for (size_t i = 0; i < labels.labels.size(); ++i) {
      if (labels.labels[i] == 0) continue;
      ASSERT_EQ(labels.labels[i], layout::kFirstBodyLabel) << "only the block";
      ++on_block;
      const auto column = static_cast<double>(i % 160) + 0.5, row = static_cast<double>(i / 160) + 0.5;
      const Vector3d at_m = optical * (depths.depths_m[i] * lineOfSight(inside.cameras[0], {column, row}));
      ASSERT_NEAR(at_m.cwiseAbs().maxCoeff(), kHalfM, kSnappedM) << i;
    }
    EXPECT_GT(on_block, 500U);
  }
}

/// docs/surface.md, for a camera that moves over the block and past it.
TEST_P(Geometry, WhatAMovingCameraDoesNotSeeIsLeftOutAndNoPictureDiffers) {
  constexpr int kFlightTicks = 20;
  const auto flight = [this](bool draw_hidden) {
    Scene close = scene();
    close.cameras[0].frame = "scope";
    close.cameras[0].vertical_fov_deg = 12;
    close.cameras[0].draw_hidden = draw_hidden;
    Session session(close, context_);
    std::vector<ImageFrame> out;
    for (int tick = 1; tick <= kFlightTicks; ++tick) {
      const double offset = static_cast<double>(tick) / kFlightTicks;
      const Eigen::AngleAxisd turn(0.6 * offset - 0.3, Vector3d::UnitZ());
      session.setCameraFrame(0, {Vector3d(0.4 * offset - 0.2, 0.1 * offset, 0.01), Quaterniond(turn)});
      FrameRequest outputs;
      outputs.cameras = outputs.depth = {true};
      outputs.every_image = true;
      for (ImageFrame& image : session.step(press(tick), outputs).images) out.push_back(std::move(image));
      for (ImageFrame& image : session.drain().images) out.push_back(std::move(image));
    }
    return out;
  };
  const std::vector<ImageFrame> all = flight(true), seen = flight(false);
  ASSERT_EQ(all.size(), seen.size());
  ASSERT_GE(all.size(), size_t{kFlightTicks});
  for (size_t i = 0; i < all.size(); ++i) {
    EXPECT_TRUE(all[i].rgb == seen[i].rgb) << "picture " << i;
    EXPECT_TRUE(all[i].depths_m == seen[i].depths_m) << "picture " << i;
  }
}

}  // namespace
}  // namespace viscera
