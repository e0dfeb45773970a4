// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/obstacle_painter.h"

#include <algorithm>
#include <cstddef>

#include "render/mesh_uniforms.h"
#include "viscera/layout/picture_labels.h"

namespace viscera {

namespace {
constexpr float kBehindSlope = 2, kBehindSteps = 16;  // of depth: per pixel of slope, and least steps of the buffer
}

ObstaclePainter::ObstaclePainter(const std::vector<ObstacleConfig>& obstacles)
    : program_(gpu::Program::graphics("mesh.vert", "tool.frag")) {
  std::vector<ToolVertex> vertices;
  std::vector<uint32_t> indices;
  for (const ObstacleConfig& obstacle : obstacles) {
    const ToolShape shape = obstacleShape(obstacle);
    const uint32_t first_vertex = static_cast<uint32_t>(vertices.size());
    for (const uint32_t index : shape.indices) indices.push_back(first_vertex + index);
    vertices.insert(vertices.end(), shape.vertices.begin(), shape.vertices.end());
    ends_.push_back(indices.size());
  }
  vertices_ = gpu::Buffer<ToolVertex>(vertices);
  indices_ = gpu::Buffer<uint32_t>(indices);
  constexpr GLuint kBinding = 0;
  inputs_.describe(kPositionInput, kBinding, 3, GL_FLOAT, GL_FALSE, offsetof(ToolVertex, position_m));
  inputs_.describe(kNormalInput, kBinding, 3, GL_FLOAT, GL_FALSE, offsetof(ToolVertex, normal));
  inputs_.describe(kColorInput, kBinding, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(ToolVertex, color));
  glVertexArrayVertexBuffer(inputs_.id(), kBinding, vertices_.id(), 0, sizeof(ToolVertex));
  glVertexArrayElementBuffer(inputs_.id(), indices_.id());
}

/// @param before  (obstacle) is called first
template <class Before>
void ObstaclePainter::drawWith(const gpu::Program& program, const std::vector<Pose>& poses,
                               const Pose& optical_from_tissue, const Eigen::Matrix4f& clip_from_optical,
                               Before before) {
  glBindVertexArray(inputs_.id());
  program.use();
  // Tissue that lies on an obstacle is where its surface is: of the two the tissue is seen.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(kBehindSlope, kBehindSteps);
  for (size_t i = 0; i < std::min(poses.size(), ends_.size()); ++i) {
    const size_t first = i == 0 ? 0 : ends_[i - 1];
    before(i);
    setMeshMatrices(program, optical_from_tissue * poses[i], clip_from_optical);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(ends_[i] - first), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(first * sizeof(uint32_t)));
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  glBindVertexArray(0);
}

void ObstaclePainter::draw(const std::vector<Pose>& poses, const Pose& optical_from_tissue,
                           const Eigen::Matrix4f& clip_from_optical) {
  drawWith(program_, poses, optical_from_tissue, clip_from_optical, [](size_t) {});
}

void ObstaclePainter::drawGeometry(const gpu::Program& program, const std::vector<Pose>& poses,
                                   const Pose& optical_from_tissue, const Eigen::Matrix4f& clip_from_optical) {
  drawWith(program, poses, optical_from_tissue, clip_from_optical, [&](size_t obstacle) {
    program.set("label", static_cast<uint32_t>(layout::kFirstObstacleLabel + obstacle));
  });
}

}  // namespace viscera
