// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Distortion of a camera: the picture agrees with the lens model, and a straight edge, undistorted, is straight.
#include <algorithm>
#include <vector>

#include <Eigen/Eigenvalues>

#include "math/srgb.h"
#include "render/drawing.h"

using namespace viscera;

namespace {

constexpr float kHalf_m = 0.2f;       ///< half width of the square
constexpr double kStraight_px = 0.3;  ///< limit for an undistorted edge; with 8 bits per pixel, edges are known to 0.1
constexpr double kBent_px = 2;        ///< the edge in the picture is bent by far more than this
constexpr int kAround_px = 5;         ///< an edge, drawn with 2 x 2 samples and resampled, is 3 pixels wide

class LensGl : public Drawing {
 protected:
  LensGl() {
    camera_.vertical_fov_deg = 80;
    camera_.up = Vector3d(0.1, 0, 1);  // edges cross rows and columns
  }
  /// Returns the position of a point in the picture of a pinhole camera [px].
  Eigen::Vector2d straight(const Eigen::Vector2d& shown) const {
    const Intrinsics k = intrinsics(camera_);
    const Vector3d sight = lineOfSight(camera_, shown);
    return {k.fx * sight.x() + k.cx, k.fy * sight.y() + k.cy};
  }
  Vector3d optical(const Vector3d& point_m) const { return opticalPose(camera_).inverse() * point_m; }
};

double level(const Image& image, int column, int row) {
  return linearFromSrgb(image.at(column, row)[0] / 255.0);
}

/// Returns the column of an edge in a row, near a column, from the covered share of the pixels around it in linear
/// light.
double edgeColumn(const Image& image, int near, int row) {
  const double left = level(image, near - kAround_px, row), right = level(image, near + kAround_px, row);
  double covered = 0;
  for (int c = near - kAround_px; c <= near + kAround_px; ++c)
    covered += (level(image, c, row) - left) / (right - left);
  return near + kAround_px + 1 - covered;
}

/// Returns the largest distance of points from their regression line.
double bentBy(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const auto& point : points) middle += point / static_cast<double>(points.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const auto& point : points) spread += (point - middle) * (point - middle).transpose();
  const Eigen::Vector2d across = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(0);
  double out = 0;
  for (const auto& point : points) out = std::max(out, std::abs(across.dot(point - middle)));
  return out;
}

const PlumbBob kBarrel{-0.2, 0.05, 0.003, -0.002, 0.001}, kPincushion{0.12, 0, -0.002, 0.001, 0};

}  // namespace

TEST_F(LensGl, AStraightEdgeUndistortedIsStraightAndWhereItIs) {
  const GpuMesh square = squareMesh(kHalf_m, {0, -1, 0});
  for (const PlumbBob& lens : {kBarrel, kPincushion}) {
    camera_.distortion = lens;
    renderer_.reset();
    const Image image = draw(square.view());
    for (const double side : {-1.0, 1.0}) {
      const Vector3d from = optical({side * kHalf_m, 0, kHalf_m}), to = optical({side * kHalf_m, 0, -kHalf_m});
      std::vector<Eigen::Vector2d> shown, seen;
      double off_px = 0;
      for (double share = 0.05; share < 0.95; share += 0.01) {
        const auto at = pixelOf(camera_, from + share * (to - from));
        ASSERT_TRUE(at);
        const int row = static_cast<int>(at->y()), near = static_cast<int>(at->x());
        if (row < 0 || row >= image.height || near < kAround_px || near + kAround_px >= image.width) continue;
        shown.emplace_back(edgeColumn(image, near, row), row + 0.5);
        seen.push_back(straight(shown.back()));
        const Intrinsics k = intrinsics(camera_);
        const auto plane = [&](const Vector3d& p) {
          return Eigen::Vector2d(k.fx * p.x() / p.z() + k.cx, k.fy * p.y() / p.z() + k.cy);
        };
        const Eigen::Vector2d along = (plane(to) - plane(from)).normalized(), off = seen.back() - plane(from);
        off_px = std::max(off_px, std::abs(along.x() * off.y() - along.y() * off.x()));
      }
      ASSERT_GT(shown.size(), 50U);
      EXPECT_GT(bentBy(shown), kBent_px) << "k1 " << lens.k1 << ", side " << side;
      EXPECT_LT(bentBy(seen), kStraight_px) << "k1 " << lens.k1 << ", side " << side;
      EXPECT_LT(off_px, kStraight_px) << "k1 " << lens.k1 << ", side " << side;
    }
  }
}

TEST_F(LensGl, APictureHasTheCamerasSizeAndNothingOfItIsMissing) {
  const GpuMesh wall = squareMesh(2, {0, -1, 0});  // fills the picture
  for (const PlumbBob& lens : {kBarrel, kPincushion}) {
    camera_.distortion = lens;
    renderer_.reset();
    const Image image = draw(wall.view());
    int dark = 0;
    for (int row = 0; row < image.height; ++row) {
      for (int column = 0; column < image.width; ++column) dark += image.at(column, row)[0] < 30 ? 1 : 0;
    }
    EXPECT_EQ(dark, 0) << "k1 " << lens.k1;
  }
}

TEST_F(LensGl, DrawingThroughALensMakesNoObject) {
  const GpuMesh square = squareMesh(kHalf_m, {0, -1, 0});
  camera_.distortion = kBarrel;
  draw(square.view());
  renderer().drawGeometry(0, square.view(), {});
  const size_t objects = gpu::objectsCreated();
  const Image first = draw(square.view());
  renderer().drawGeometry(0, square.view(), {});
  EXPECT_EQ(gpu::objectsCreated(), objects);
  EXPECT_EQ(draw(square.view()).rgb, first.rgb);
}
