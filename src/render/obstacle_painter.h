// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "render/obstacle_shape.h"
#include "render/vertex_array.h"

namespace viscera {

/// Draws the obstacles of a scene, with shaders/draw/mesh.vert and tool.frag.
class ObstaclePainter {
 public:
  explicit ObstaclePainter(const std::vector<ObstacleConfig>& obstacles);
  /// Draws into the bound framebuffer. @param poses  [obstacles] tissue frame; those that are missing are not drawn
  void draw(const std::vector<Pose>& poses, const Pose& optical_from_tissue, const Eigen::Matrix4f& clip_from_optical);

  /// The same with another program: geometry.frag.
  void drawGeometry(const gpu::Program& program, const std::vector<Pose>& poses, const Pose& optical_from_tissue,
                    const Eigen::Matrix4f& clip_from_optical);

 private:
  template <class Before>
  void drawWith(const gpu::Program& program, const std::vector<Pose>& poses, const Pose& optical_from_tissue,
                const Eigen::Matrix4f& clip_from_optical, Before before);

  gpu::Program program_;
  VertexArray inputs_;
  gpu::Buffer<ToolVertex> vertices_;
  gpu::Buffer<uint32_t> indices_;
  std::vector<size_t> ends_;  ///< [obstacles] index behind the last of each
};

}  // namespace viscera
