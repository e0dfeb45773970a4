// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/drawing.h"
#include "render/shapes/obstacle_shape.h"

using namespace viscera;

namespace {

ObstacleConfig obstacle(ObstacleShape shape) {
  ObstacleConfig out;
  out.shape = shape;
  out.radius_m = 0.02;
  out.length_m = 0.04;
  out.size_m = Vector3d(0.06, 0.004, 0.03);
  return out;
}

class ObstaclesGl : public Drawing {
 protected:
  Image drawn(const ObstacleConfig& config, const std::vector<Pose>& poses) {
    Renderer renderer({camera_}, {}, {config});
    renderer.placeObstacles(poses);
    return draw(renderer, nothing_);
  }
  double pixelsPerMetre() const { return intrinsics(camera_).fy / 0.3; }
  const MeshView nothing_;
};

constexpr double kOutline = 0.08;  // share of the area: perspective, and rounding of the outline to pixels

}  // namespace

TEST_F(ObstaclesGl, SpheresCapsulesAndBoxesAreAsLargeAsWhatNodesMeet) {
  const double pixels = pixelsPerMetre() * pixelsPerMetre();
  const double circle = M_PI * 0.02 * 0.02;
  const std::pair<ObstacleShape, double> expected[] = {{ObstacleShape::kSphere, circle},
                                                       {ObstacleShape::kCapsule, circle + 0.04 * 0.04},
                                                       {ObstacleShape::kBox, 0.06 * 0.03}};
  for (const auto& [shape, area_m2] : expected) {
    const Image image = drawn(obstacle(shape), {Pose{}});
    EXPECT_NEAR(image.drawnPixels(), area_m2 * pixels, kOutline * area_m2 * pixels);
    EXPECT_LT((image.center() - Eigen::Vector2d(160, 120)).norm(), 1);
  }
}

TEST_F(ObstaclesGl, APlaneIsSeenFromAboveAndLiesWhereItsPoseSays) {
  const Pose floor{Vector3d(0, 0, -0.03), Quaterniond::Identity()};
  const Image image = drawn(obstacle(ObstacleShape::kPlane), {floor});
  EXPECT_FALSE(image.drawn(160, 100));  // above the horizon of a finite floor
  EXPECT_TRUE(image.drawn(160, 200));
}

TEST_F(ObstaclesGl, AnObstacleIsDrawnWhereItIsAndNowhereBeforeItIsPlaced) {
  EXPECT_EQ(drawn(obstacle(ObstacleShape::kSphere), {}).drawnPixels(), 0);
  const Image moved = drawn(obstacle(ObstacleShape::kSphere), {{Vector3d(0.05, 0, 0), Quaterniond::Identity()}});
  EXPECT_NEAR(moved.center().x(), 160 + 0.05 * pixelsPerMetre(), 2);
}

TEST(ObstacleShape, PointsOutwardEverywhere) {
  for (const ObstacleShape shape : {ObstacleShape::kSphere, ObstacleShape::kCapsule, ObstacleShape::kBox}) {
    const ToolShape drawn = obstacleShape(obstacle(shape));
    for (size_t i = 0; i < drawn.indices.size(); i += 3) {
      Vector3f corner[3];
      for (size_t c = 0; c < 3; ++c) corner[c] = Vector3f(drawn.vertices[drawn.indices[i + c]].position_m.data());
      const Vector3f normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
      EXPECT_GE(normal.dot(corner[0] + corner[1] + corner[2]), -1e-12f);
    }
  }
}
