// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "render/mesh_uniforms.h"
#include "render/shapes/tool_shape.h"
#include "render/vertex_array.h"
#include "viscera/math/types.h"
#include "viscera/solver/visible_tube.h"

namespace viscera {

/// Appearance of a suture, a needle, a clip or a strand.
struct TubeStyle {
  double radius_m;
  std::array<uint8_t, 4> color;  ///< sRGB, solid
  size_t nodes;                  ///< that it has
  size_t suture;                 ///< index in the scene, of a needle that of its suture; of clips and strands 0
  TubeKind part = TubeKind::kSuture;
  size_t most = 1;  ///< most pieces of it
};

/// Draws sutures as tubes along their nodes, at least a pixel and a half wide. With the shaders of tools.
class TubePainter {
 public:
  TubePainter(std::vector<TubeStyle> sutures, const std::vector<std::string>& features);
  void lightFor(const CameraConfig& camera) { setLight(program_, camera); }  ///< for drawing after this call
  /// Draws into the bound framebuffer.
  /// @param shown  of these sutures, in pieces or whole
  /// @param pixel  its width at a distance of 1
  void draw(const VisibleTubes& shown, const Pose& optical_from_tissue, const Eigen::Matrix4f& clip_from_optical,
            double pixel);
  /// Draws with another program, in use: geometry.frag. Leaves strands out, which have no label.
  void drawGeometry(const gpu::Program& program, const VisibleTubes& shown, const Pose& optical_from_tissue,
                    const Eigen::Matrix4f& clip_from_optical, double pixel);

 private:
  template <class Before>
  void drawWith(const gpu::Program& program, const VisibleTubes& shown, const Pose& optical_from_tissue,
                const Eigen::Matrix4f& clip_from_optical, double pixel, bool strands, Before before);
  void shape(const TubeStyle& suture, const VisibleTube& piece, const Pose& optical_from_tissue, double pixel);

  std::vector<TubeStyle> sutures_;
  gpu::Program program_;
  VertexArray inputs_;
  gpu::Buffer<ToolVertex> vertices_;  ///< of all sutures in order
  gpu::Buffer<uint32_t> indices_;     ///< of the longest
  // Of the suture being drawn, optical frame.
  std::vector<Vector3f> points_m_;
  std::vector<float> radii_m_;
  ToolShape tube_;
};

}  // namespace viscera
