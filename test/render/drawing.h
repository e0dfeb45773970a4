// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/gl.h"
#include "render/renderer.h"
#include "viscera/gpu/context.h"
#include "viscera/model/scene/stylus_config.h"

namespace viscera {

/// A mesh of one colour on the GPU, made from given vertices.
struct GpuMesh {
  gpu::Buffer<float> positions;
  gpu::Buffer<uint32_t> normals, colors, indices;

  GpuMesh(const std::vector<Vector3f>& points_m, const std::vector<Vector3f>& point_normals,
          const std::vector<uint32_t>& triangles, uint32_t rgba = 0xff4048b8u)
      : colors(std::vector<uint32_t>(points_m.size(), rgba)), indices(triangles) {
    std::vector<float> xyz;
    std::vector<uint32_t> packed;
    for (const Vector3f& p : points_m) xyz.insert(xyz.end(), {p.x(), p.y(), p.z()});
    for (const Vector3f& n : point_normals) packed.push_back(packNormal(n));
    positions = gpu::Buffer<float>(xyz);
    normals = gpu::Buffer<uint32_t>(packed);
  }
  MeshView view() const { return {positions.id(), normals.id(), colors.id(), indices.id(), indices.size()}; }
};

/// Returns the unit directions of a sphere's vertices, in rings from +z to -z. Each ring is closed.
inline std::vector<Vector3f> sphereDirections(int rings, int segments) {
  std::vector<Vector3f> out;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < segments; ++j) {
      const double polar = M_PI * i / rings, turn = 2 * M_PI * j / segments;
      out.push_back(
          Vector3d(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)).cast<float>());
    }
  }
  return out;
}

inline std::vector<uint32_t> sphereTriangles(uint32_t rings, uint32_t segments) {
  std::vector<uint32_t> out;
  for (uint32_t i = 0; i < rings; ++i) {
    for (uint32_t j = 0; j < segments; ++j) {
      const uint32_t a = i * segments + j, b = i * segments + (j + 1) % segments;
      for (uint32_t index : {a, a + segments, b + segments, a, b + segments, b}) out.push_back(index);
    }
  }
  return out;
}

inline GpuMesh sphereMesh(const Vector3f& center_m, float radius_m) {
  constexpr int kRings = 24, kSegments = 48;
  const std::vector<Vector3f> directions = sphereDirections(kRings, kSegments);
  std::vector<Vector3f> points_m;
  for (const Vector3f& direction : directions) points_m.push_back(center_m + radius_m * direction);
  return GpuMesh(points_m, directions, sphereTriangles(kRings, kSegments));
}

/// Returns a square in the plane y = 0, 2 `half_m` wide, with its front towards -y and with the given normals.
inline GpuMesh squareMesh(float half_m, const Vector3f& normal, bool front_to_minus_y = true) {
  const std::vector<Vector3f> corners = {
      {-half_m, 0, -half_m}, {half_m, 0, -half_m}, {half_m, 0, half_m}, {-half_m, 0, half_m}};
  const std::vector<uint32_t> front = {0, 1, 2, 0, 2, 3}, back = {0, 2, 1, 0, 3, 2};
  return GpuMesh(corners, std::vector<Vector3f>(4, normal), front_to_minus_y ? front : back);
}

/// RGB8 image, rows from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;

  const uint8_t* at(int column, int row) const { return &rgb[3 * (static_cast<size_t>(row) * width + column)]; }
  int sum(int column, int row) const { return at(column, row)[0] + at(column, row)[1] + at(column, row)[2]; }
  /// Returns whether a pixel differs from the corner, which is background in every test.
  bool drawn(int column, int row) const { return !std::equal(at(column, row), at(column, row) + 3, rgb.begin()); }
  int drawnPixels() const {
    int count = 0;
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) count += drawn(column, row) ? 1 : 0;
    }
    return count;
  }
  /// Returns the mean position of the drawn pixels [px], with pixel centres at halves.
  Eigen::Vector2d center() const {
    Eigen::Vector2d total = Eigen::Vector2d::Zero();
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        if (drawn(column, row)) total += Eigen::Vector2d(column + 0.5, row + 0.5);
      }
    }
    return total / drawnPixels();
  }
};

/// Fixture of tests that draw: a context, and a camera in front of the origin that looks along +y with z up.
class Drawing : public ::testing::Test {
 protected:
  Drawing() {
    camera_.position_m = Vector3d(0, -0.3, 0);
    camera_.width_px = 320;
    camera_.height_px = 240;
  }
  Image draw(const MeshView& mesh, const ToolMotions& motions = {}) { return draw(renderer(), mesh, motions); }
  Image draw(Renderer& renderer, const MeshView& mesh, const ToolMotions& motions = {}) {
    renderer.draw(0, mesh, motions);
    Image image{camera_.width_px, camera_.height_px, {}};
    image.rgb.resize(size_t{3} * image.width * image.height);
    glReadPixels(0, 0, image.width, image.height, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
    gpu::checkErrors("a drawing test");
    return image;
  }
  Renderer& renderer() {
    if (!renderer_) renderer_ = std::make_unique<Renderer>(std::vector<CameraConfig>{camera_}, styluses_);
    return *renderer_;
  }

  gpu::Context context_;
  CameraConfig camera_;
  std::vector<StylusConfig> styluses_ = std::vector<StylusConfig>(2);
  std::unique_ptr<Renderer> renderer_;
};

}  // namespace viscera
