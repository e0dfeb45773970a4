// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "render/mesh_uniforms.h"
#include "render/shapes/obstacle_shape.h"
#include "render/vertex_array.h"
#include "viscera/model/scene/environment_config.h"

namespace viscera {

/// Draws the obstacles of a scene, with shaders/draw/mesh.vert and tool.frag.
class ObstaclePainter {
 public:
  ObstaclePainter(const std::vector<ObstacleConfig>& obstacles, const std::vector<std::string>& features);
  void lightFor(const CameraConfig& camera) { setLight(program_, camera); }  ///< for drawing after this call
  /// Draws into the bound framebuffer. @param poses  [obstacles] tissue frame; obstacles without one are not drawn
  void draw(const std::vector<Pose>& poses, const Pose& optical_from_tissue, const Eigen::Matrix4f& clip_from_optical);

  /// Draws depths and labels with geometry.frag; spheres and capsules are exact, not their triangles.
  /// @param program  geometry.frag as it is for triangles
  void drawGeometry(const gpu::Program& program, const std::vector<Pose>& poses, const Pose& optical_from_tissue,
                    const Eigen::Matrix4f& clip_from_optical);

 private:
  /// A sphere or a capsule in its own frame; radius 0: neither.
  struct Round {
    float radius_m = 0, half_length_m = 0;
  };
  template <class Begin>
  void drawWith(const std::vector<Pose>& poses, Begin begin);
  const gpu::Program& beginRound(const Round& round, const Pose& optical_from_obstacle,
                                 const Eigen::Matrix4f& clip_from_optical);

  gpu::Program program_;
  gpu::Program round_program_;  ///< made when first needed
  std::vector<Round> rounds_;   ///< [obstacles]
  VertexArray inputs_;
  gpu::Buffer<ToolVertex> vertices_;
  gpu::Buffer<uint32_t> indices_;
  std::vector<size_t> ends_;  ///< [obstacles] index after the last of each
};

}  // namespace viscera
