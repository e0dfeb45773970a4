// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/renderer.h"

#include <algorithm>

#include "gpu/readback.h"
#include "render/drawing.h"
#include "viscera/math/error.h"

using namespace viscera;

namespace {

class RendererGl : public Drawing {};

const Vector3f kToCamera(0, -1, 0);

double meanSum(const Image& image) {
  double total = 0;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      if (image.drawn(column, row)) total += image.sum(column, row);
    }
  }
  return total / image.drawnPixels();
}

/// Leaves state behind as another user of the context might.
void disturbState() {
  glEnable(GL_SCISSOR_TEST);
  glScissor(3, 3, 5, 5);
  glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_ALWAYS);
  glDepthRange(1, 0);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_FRONT);
  glFrontFace(GL_CCW);
  glEnable(GL_BLEND);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  glViewport(0, 0, 7, 7);
}

}  // namespace

TEST_F(RendererGl, SphereIsDrawnOnADarkBackground) {
  const GpuMesh sphere = sphereMesh({0, 0, 0}, 0.05f);
  const Image image = draw(sphere.view());
  EXPECT_GT(image.drawnPixels(), 3000);
  EXPECT_GT(meanSum(image), 3 * image.sum(0, 0));
  EXPECT_GT(image.at(160, 120)[0], 2 * image.at(160, 120)[2]) << "the tissue's red is lost";
}

TEST_F(RendererGl, BackgroundIsEncodedAsSrgb) {
  // linear light 0.0056, 0.0066, 0.0080 after the sRGB transfer function
  const GpuMesh sphere = sphereMesh({0, 0, 0}, 0.01f);
  const Image image = draw(sphere.view());
  EXPECT_EQ(std::vector<int>(image.at(0, 0), image.at(0, 0) + 3), (std::vector<int>{17, 19, 22}));
}

TEST_F(RendererGl, SphereAppearsWhereIntrinsicsAndPoseProjectIt) {
  constexpr double kWithin_px = 1;
  camera_.position_m = Vector3d(0.1, -0.25, 0.2);
  camera_.target_m = Vector3d(0.01, 0.02, -0.01);
  camera_.up = Vector3d(0.2, 0, 1);
  const Intrinsics k = intrinsics(camera_);
  for (const Vector3d& point : {Vector3d(0, 0, 0), Vector3d(0.05, 0, 0.02), Vector3d(-0.04, 0.03, 0.05)}) {
    const GpuMesh sphere = sphereMesh(point.cast<float>(), 0.004f);
    const Vector3d optical = opticalPose(camera_).inverse() * point;
    const Eigen::Vector2d expected(k.fx * optical.x() / optical.z() + k.cx, k.fy * optical.y() / optical.z() + k.cy);
    const Image image = draw(sphere.view());
    ASSERT_GT(image.drawnPixels(), 10);
    EXPECT_LT((image.center() - expected).norm(), kWithin_px)
        << image.center().transpose() << " for " << expected.transpose();
  }
}

TEST_F(RendererGl, WhatIsAboveTheTargetIsInTheFirstRows) {
  const GpuMesh above = sphereMesh({0, 0, 0.05f}, 0.01f);
  EXPECT_LT(draw(above.view()).center().y(), camera_.height_px / 2 - 20);
  const GpuMesh right = sphereMesh({0.05f, 0, 0}, 0.01f);
  EXPECT_GT(draw(right.view()).center().x(), camera_.width_px / 2 + 20);
}

TEST_F(RendererGl, BackFacesAreDarkerThanFrontFaces) {
  const GpuMesh front = squareMesh(0.05f, kToCamera), back = squareMesh(0.05f, -kToCamera, false);
  const double front_sum = meanSum(draw(front.view())), back_sum = meanSum(draw(back.view()));
  EXPECT_LT(back_sum, 0.7 * front_sum);
  EXPECT_GT(back_sum, 1.5 * draw(back.view()).sum(0, 0)) << "the inside is seen, not black";
}

TEST_F(RendererGl, TornTrianglesDrawNothing) {
  constexpr uint32_t kRings = 24, kSegments = 48;
  std::vector<uint32_t> torn = sphereTriangles(kRings, kSegments), kept;
  for (size_t first = 0; first < torn.size(); first += 3) {
    if (first / 3 % 3 == 0) {
      std::fill_n(torn.begin() + static_cast<long>(first), 3, 0u);
    } else {
      kept.insert(kept.end(), torn.begin() + static_cast<long>(first), torn.begin() + static_cast<long>(first) + 3);
    }
  }
  std::vector<Vector3f> directions = sphereDirections(kRings, kSegments), points;
  for (const Vector3f& direction : directions) points.push_back(0.05f * direction);
  const GpuMesh with_torn(points, directions, torn), without(points, directions, kept);
  EXPECT_EQ(draw(with_torn.view()).rgb, draw(without.view()).rgb);
  const GpuMesh all_torn(points, directions, std::vector<uint32_t>(300, 0));
  EXPECT_EQ(draw(all_torn.view()).drawnPixels(), 0);
}

TEST_F(RendererGl, NullNormalsAreShadedFlat) {
  constexpr double kWithinLevels = 2;  // sum over three channels; packed normals are exact to 1/511
  const GpuMesh smooth = squareMesh(0.05f, kToCamera), flat = squareMesh(0.05f, Vector3f::Zero());
  EXPECT_NEAR(meanSum(draw(flat.view())), meanSum(draw(smooth.view())), kWithinLevels);
  const GpuMesh inside = squareMesh(0.05f, -kToCamera, false), flat_inside = squareMesh(0.05f, Vector3f::Zero(), false);
  EXPECT_NEAR(meanSum(draw(flat_inside.view())), meanSum(draw(inside.view())), kWithinLevels);
}

TEST_F(RendererGl, NearerSurfaceHidesTheFarther) {
  // Two squares in one mesh, the far one last and twice as large: the near one stays visible.
  const float far_y = 0.05f, near_y = -0.05f;
  std::vector<Vector3f> points, normals;
  for (const auto& [y, half] : {std::pair(near_y, 0.02f), std::pair(far_y, 0.08f)}) {
    for (const auto& [x, z] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) points.emplace_back(x * half, y, z * half);
    const bool is_near = y == near_y;
    for (int i = 0; i < 4; ++i) normals.push_back(is_near ? kToCamera : Vector3f(1, 0, 0));
  }
  const GpuMesh both(points, normals, {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7});
  const GpuMesh alone(points, normals, {0, 1, 2, 0, 2, 3});
  const Image with_far = draw(both.view()), near_only = draw(alone.view());
  EXPECT_EQ(with_far.sum(160, 120), near_only.sum(160, 120));
  EXPECT_GT(with_far.drawnPixels(), 2 * near_only.drawnPixels());
}

TEST_F(RendererGl, DrawMakesNoObjectAndCountsItself) {
  const GpuMesh sphere = sphereMesh({0, 0, 0}, 0.05f);
  ToolMotions motions;
  motions[0].present = motions[1].present = true;
  motions[0].mode = ToolMode::kGrab;
  renderer();
  const size_t objects = gpu::objectsCreated();
  for (int i = 0; i < 3; ++i) draw(sphere.view(), motions);
  EXPECT_EQ(gpu::objectsCreated(), objects);
  EXPECT_EQ(renderer().renders(), 3u);
}

TEST_F(RendererGl, ImageDoesNotDependOnTheStateLeftByOthers) {
  const GpuMesh sphere = sphereMesh({0, 0, 0}, 0.05f);
  ToolMotions motions;
  motions[0].present = true;
  motions[0].mode = ToolMode::kGrab;
  motions[0].to.position_m = Vector3d(0, -0.06, 0);
  const Image calm = draw(sphere.view(), motions);
  draw({}, {});  // an image that is not drawn would otherwise be the old one
  disturbState();
  EXPECT_EQ(draw(sphere.view(), motions).rgb, calm.rgb);
}

TEST_F(RendererGl, SupersamplingSmoothsEdges) {
  camera_.up = Vector3d(0.3, 0, 1);  // makes the square's edges oblique
  const GpuMesh square = squareMesh(0.05f, kToCamera);
  auto between = [&](int supersampling) {
    CameraConfig camera = camera_;
    camera.supersampling = supersampling;
    Renderer renderer({camera}, styluses_);
    const Image image = draw(renderer, square.view());
    const int background = image.sum(0, 0), inside = image.sum(160, 120);
    int count = 0;
    for (int row = 0; row < image.height; ++row) {
      for (int column = 0; column < image.width; ++column) {
        count += image.sum(column, row) > 1.5 * background && image.sum(column, row) < 0.85 * inside ? 1 : 0;
      }
    }
    return count;
  };
  EXPECT_EQ(between(1), 0);
  EXPECT_GT(between(2), 100);
}

TEST_F(RendererGl, ResultIsLeftBoundForReadback) {
  const GpuMesh sphere = sphereMesh({0, 0, 0.05f}, 0.02f);
  const Image image = draw(sphere.view());
  gpu::ReadbackRing ring(image.rgb.size());
  renderer().draw(0, sphere.view(), {});
  ASSERT_TRUE(ring.requestPixels(image.width, image.height, 1));
  const auto* rows = static_cast<const uint8_t*>(ring.collect(nullptr, true));
  ASSERT_NE(rows, nullptr);
  EXPECT_TRUE(std::equal(image.rgb.begin(), image.rgb.end(), rows));
  ring.release();
}

TEST_F(RendererGl, EveryCameraHasItsOwnImage) {
  CameraConfig small = camera_;
  small.width_px = 64;
  small.height_px = 48;
  Renderer two({camera_, small}, styluses_);
  const GpuMesh sphere = sphereMesh({0, 0, 0}, 0.05f);
  two.draw(1, sphere.view(), {});
  std::vector<uint8_t> rgb(size_t{3} * 64 * 48);
  glReadPixels(0, 0, 64, 48, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
  EXPECT_GT(rgb[3 * (24 * 64 + 32)], 100) << "the sphere fills the middle of the small image";
  EXPECT_LT(rgb[0], 30);
}

TEST_F(RendererGl, ImageTooLargeForTheDriverIsRefusedWithTheLimit) {
  camera_.width_px = 1 << 20;
  try {
    renderer();
    FAIL() << "made a framebuffer of a million columns";
  } catch (const GpuError& e) {
    EXPECT_NE(std::string(e.what()).find("1048576 x 240"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("the driver accepts 1 to"), std::string::npos) << e.what();
  }
}
