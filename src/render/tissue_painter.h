// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/program.h"
#include "render/renderer.h"
#include "render/tool_shadows.h"
#include "render/vertex_array.h"

namespace viscera {

/// Draws the skin: lit, wet, two-sided, with the shadows of tools. Owner of shaders/draw/tissue.frag, with
/// shaders/draw/mesh.vert.
class TissuePainter {
 public:
  TissuePainter();  ///< @throws GpuError  file, line and driver log of a shader that does not compile
  /// Draws into the bound framebuffer; depth test, front face and blending are the caller's.
  void draw(const MeshView& mesh, const ToolShadows& shadows, const Pose& optical_from_tissue,
            const Eigen::Matrix4f& clip_from_optical);

 private:
  gpu::Program program_;
  VertexArray inputs_;
};

}  // namespace viscera
