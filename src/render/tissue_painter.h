// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gpu/program.h"
#include "render/deferred_lighting.h"
#include "render/detail_textures.h"
#include "render/grain_texture.h"
#include "render/renderer.h"
#include "render/tool_shadows.h"
#include "render/vertex_array.h"
#include "surface/marks/mark_textures.h"

namespace viscera {

/// Draws the surface mesh: lit, wet, two-sided, with the tools' shadows. Owner of shaders/draw/tissue.frag, with
/// mesh.vert.
class TissuePainter {
 public:
  /// @param model  of the drawn textures; null: none   @param samples, pixels  makes programs for lighting per sample,
  /// or per pixel   @param features  LENS_LIGHT, CONTACTS, MARKS
  /// @throws GpuError  file, line and driver log of a shader that does not compile
  TissuePainter(const Model* model, bool samples, bool pixels, std::vector<std::string> features);
  void lightFor(const CameraConfig& camera);  ///< for drawing after this call
  /// Sets the marks for drawing after this call, which needs feature MARKS; null: none.
  void showMarks(const std::shared_ptr<const VisibleMarks>& marks) { marks_.show(marks); }
  /// Draws into the bound framebuffer; depth test, front face and blending are the caller's.
  void draw(const MeshView& mesh, const ToolShadows& shadows, const Pose& optical_from_tissue,
            const Eigen::Matrix4f& clip_from_optical);

  /// Returns whether it can light per pixel. It cannot if all bodies are cloth, where that would save little.
  bool lightsPixels() const { return light_ != nullptr; }
  /// Draws a mesh with rest positions into a target's samples, and lights its image.
  void drawPixels(const GBuffer& target, const CameraConfig& camera, const MeshView& mesh, const ToolShadows& shadows,
                  const Pose& optical_from_tissue, const Eigen::Matrix4f& clip_from_optical,
                  const float (&background)[4], const std::function<void()>& pause);
  const DeferredLighting& light() const { return *light_; }

  /// Draws with another program: geometry.frag.
  void drawGeometry(const gpu::Program& program, const MeshView& mesh, const Pose& optical_from_tissue,
                    const Eigen::Matrix4f& clip_from_optical);

 private:
  void bindAtRest(const MeshView& mesh) const;
  void drawAtRest(const gpu::Program& program, const MeshView& mesh) const;
  void useWith(const gpu::Program& program, const ToolShadows& shadows, const Pose& optical_from_tissue,
               const Eigen::Matrix4f& clip_from_optical);

  std::unique_ptr<DetailTextures> detail_;  ///< null where no surface mesh has any
  std::unique_ptr<GrainTexture> grain_;     ///< null where all is cloth
  gpu::Program program_, tissue_program_;   ///< the latter for all vertices with a rest position
  gpu::Program depth_program_;              ///< drawn first, so that hidden fragments are not shaded
  gpu::Program seen_program_;
  std::unique_ptr<DeferredLighting> light_;  ///< null: not requested, or all is cloth
  VertexArray inputs_, tissue_inputs_;
  bool has_marks_ = false;  ///< programs have feature MARKS
  MarkTextures marks_;
};

}  // namespace viscera
