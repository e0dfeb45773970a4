// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gpu/program.h"
#include "render/detail_textures.h"
#include "render/grain_texture.h"
#include "render/renderer.h"
#include "render/seen_light.h"
#include "render/tool_shadows.h"
#include "render/vertex_array.h"

namespace viscera {

/// Draws the skin: lit, wet, two-sided, with the tools' shadows. Owner of shaders/draw/tissue.frag, with mesh.vert.
class TissuePainter {
 public:
  /// @param model  whose textures are drawn; null: none are   @param samples, pixels  which ways to draw are to be
  /// there for what has them: lit sample by sample, or pixel by pixel   @param features  LENS_LIGHT, CONTACTS
  /// @throws GpuError  file, line and driver log of a shader that does not compile
  TissuePainter(const Model* model, bool samples, bool pixels, std::vector<std::string> features);
  void lightFor(const CameraConfig& camera);  ///< what is drawn from now on
  /// Draws into the bound framebuffer; depth test, front face and blending are the caller's.
  void draw(const MeshView& mesh, const ToolShadows& shadows, const Pose& optical_from_tissue,
            const Eigen::Matrix4f& clip_from_optical);

  /// Can it light pixels? Where nothing is but cloth there is little to be lit.
  bool lightsPixels() const { return light_ != nullptr; }
  /// Draws what a mesh with places at rest looks like into a target's samples, and lights its image.
  void drawPixels(const SeenTarget& target, const CameraConfig& camera, const MeshView& mesh,
                  const ToolShadows& shadows, const Pose& optical_from_tissue, const Eigen::Matrix4f& clip_from_optical,
                  const float (&background)[4], const std::function<void()>& pause);
  const SeenLight& light() const { return *light_; }

  /// The same with another program: geometry.frag.
  void drawGeometry(const gpu::Program& program, const MeshView& mesh, const Pose& optical_from_tissue,
                    const Eigen::Matrix4f& clip_from_optical);

 private:
  void bindAtRest(const MeshView& mesh) const;
  void drawAtRest(const gpu::Program& program, const MeshView& mesh) const;
  void useWith(const gpu::Program& program, const ToolShadows& shadows, const Pose& optical_from_tissue,
               const Eigen::Matrix4f& clip_from_optical);

  std::unique_ptr<DetailTextures> detail_;  ///< null where no skin has any
  std::unique_ptr<GrainTexture> grain_;     ///< null where all is cloth
  gpu::Program program_, tissue_program_;   ///< the latter for all that has a place at rest
  gpu::Program depth_program_;              ///< before it, so that what is hidden is not shaded
  gpu::Program seen_program_;
  std::unique_ptr<SeenLight> light_;  ///< null: none is wanted, or all is cloth
  VertexArray inputs_, tissue_inputs_;
};

}  // namespace viscera
