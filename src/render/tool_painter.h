// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "model/scene/tool_kinds.h"
#include "render/mesh_uniforms.h"
#include "render/shapes/tool_shape.h"
#include "render/vertex_array.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// Draws the styluses that are present, each in its mode. Owner of shaders/draw/tool.frag, with shaders/draw/mesh.vert.
class ToolPainter {
 public:
  ToolPainter(const std::vector<StylusConfig>& styluses, const std::vector<std::string>& features);
  void lightFor(const CameraConfig& camera) { setLight(program_, camera); }  ///< for drawing after this call
  /// Draws into the bound framebuffer, after the tissue, which shows through the outlines of tools.
  void draw(const ToolMotions& motions, const Pose& optical_from_tissue, const Eigen::Matrix4f& clip_from_optical);

  bool showsAny(const ToolMotions& motions) const;

  /// Draws solid parts with another program: geometry.frag.
  void drawGeometry(const gpu::Program& program, const ToolMotions& motions, const Pose& optical_from_tissue,
                    const Eigen::Matrix4f& clip_from_optical);

 private:
  /// Of a kind of tool, in order: solid parts, translucent parts, and one of two fingers.
  struct Range {
    size_t first_index = 0, solid_indices = 0, translucent_indices = 0, finger_indices = 0;
  };
  enum class Part { kSolid, kTranslucent };
  template <class Before>
  void drawPart(const gpu::Program& program, Part part, const ToolMotions& motions, const Pose& optical_from_tissue,
                const Eigen::Matrix4f& clip_from_optical, Before before);

  const std::vector<StylusConfig> styluses_;
  gpu::Program program_;
  VertexArray inputs_;
  gpu::Buffer<ToolVertex> vertices_;
  gpu::Buffer<uint32_t> indices_;
  std::vector<std::array<Range, kToolKindCount>> ranges_;  ///< [styluses][kinds]
};

}  // namespace viscera
