// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/obstacle_painter.h"

#include <algorithm>
#include <array>

#include "render/mesh_uniforms.h"
#include "viscera/layout/picture_labels.h"

namespace viscera {

namespace {
constexpr float kBehindSlope = 2, kBehindSteps = 16;  // of depth: per pixel of slope, and in least steps of the buffer
constexpr float kAround = 1.01f;  // triangles of lathes (lathe.h) are up to 0.7 % of the radius inside their shape
}  // namespace

ObstaclePainter::ObstaclePainter(const std::vector<ObstacleConfig>& obstacles, const std::vector<std::string>& features)
    : program_(gpu::Program::graphics("mesh.vert", "tool.frag", features)) {
  std::vector<ToolVertex> vertices;
  std::vector<uint32_t> indices;
  for (const ObstacleConfig& obstacle : obstacles) {
    const ToolShape shape = obstacleShape(obstacle);
    const uint32_t first_vertex = static_cast<uint32_t>(vertices.size());
    for (const uint32_t index : shape.indices) indices.push_back(first_vertex + index);
    vertices.insert(vertices.end(), shape.vertices.begin(), shape.vertices.end());
    ends_.push_back(indices.size());
    Round& round = rounds_.emplace_back();
    const bool capsule = obstacle.shape == ObstacleShape::kCapsule;
    if (capsule) round.half_length_m = static_cast<float>(0.5 * obstacle.length_m);
    if (capsule || obstacle.shape == ObstacleShape::kSphere) round.radius_m = static_cast<float>(obstacle.radius_m);
  }
  vertices_ = gpu::Buffer<ToolVertex>(vertices);
  indices_ = gpu::Buffer<uint32_t>(indices);
  inputs_.readTools(vertices_.id(), indices_.id());
}

/// Draws all obstacles. @param begin  sets the program and uniforms of an obstacle
template <class Begin>
void ObstaclePainter::drawWith(const std::vector<Pose>& poses, Begin begin) {
  glBindVertexArray(inputs_.id());
  // Where tissue touches an obstacle, both surfaces coincide: the tissue is shown.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(kBehindSlope, kBehindSteps);
  for (size_t i = 0; i < std::min(poses.size(), ends_.size()); ++i) {
    const size_t first = i == 0 ? 0 : ends_[i - 1];
    begin(i);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(ends_[i] - first), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(first * sizeof(uint32_t)));
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  glBindVertexArray(0);
}

void ObstaclePainter::draw(const std::vector<Pose>& poses, const Pose& optical_from_tissue,
                           const Eigen::Matrix4f& clip_from_optical) {
  program_.use();
  drawWith(poses, [&](size_t i) { setMeshMatrices(program_, optical_from_tissue * poses[i], clip_from_optical); });
}

/// Sets up triangles a little outside the shape; the program discards pixels outside the shape.
const gpu::Program& ObstaclePainter::beginRound(const Round& round, const Pose& optical_from_obstacle,
                                                const Eigen::Matrix4f& clip_from_optical) {
  if (!round_program_) round_program_ = gpu::Program::graphics("mesh.vert", "geometry.frag", {"ROUND"});
  round_program_.use();
  Eigen::Matrix4f around = poseMatrix(optical_from_obstacle);
  around.leftCols<3>() *= kAround;
  round_program_.setMatrix("optical_from_mesh", around.data());
  round_program_.setMatrix("clip_from_optical", clip_from_optical.data());
  const auto end = [&](double side) -> std::array<float, 4> {
    const Vector3f at = (optical_from_obstacle * Vector3d(0, 0, side * round.half_length_m)).cast<float>();
    return {at.x(), at.y(), at.z(), round.radius_m};
  };
  round_program_.setVectors("first_end", end(-1).data(), 4, 1);
  round_program_.setVectors("last_end", end(1).data(), 4, 1);
  return round_program_;
}

void ObstaclePainter::drawGeometry(const gpu::Program& program, const std::vector<Pose>& poses,
                                   const Pose& optical_from_tissue, const Eigen::Matrix4f& clip_from_optical) {
  drawWith(poses, [&](size_t i) {
    const Pose optical_from_obstacle = optical_from_tissue * poses[i];
    const gpu::Program* drawing = &program;
    if (rounds_[i].radius_m > 0) {
      drawing = &beginRound(rounds_[i], optical_from_obstacle, clip_from_optical);
    } else {
      program.use();
      setMeshMatrices(program, optical_from_obstacle, clip_from_optical);
    }
    drawing->set("label", static_cast<uint32_t>(layout::kFirstObstacleLabel + i));
  });
  program.use();
}

}  // namespace viscera
