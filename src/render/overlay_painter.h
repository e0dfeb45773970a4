// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "render/render_target.h"
#include "render/shapes/tool_shape.h"
#include "render/vertex_array.h"
#include "surface/overlay/node_overlay.h"
#include "surface/visible_triangles.h"
#include "viscera/model/scene/overlays.h"
#include "viscera/render/arrow.h"
#include "viscera/render/camera.h"

namespace viscera {

struct MeshView;

/// Overlays of an image, and the state that they show.
struct OverlayStyle {
  Overlays shown;
  double strain_range = 1;  ///< the end of the scale
  StateView state;
  const Surface* surface = nullptr;  ///< that follows the state
  const std::vector<Arrow>* arrows = nullptr;
  const IndexRuns* runs = nullptr;  ///< see Renderer::draw
  uint64_t capture = 0;  ///< images with equal numbers show one state, and share what is computed from it; 0: alone
};

/// Draws overlays: strain in place of the tissue's colours, lines that show faintly through it, arrows, a legend.
class OverlayPainter {
 public:
  /// Needs a current context. @param model  must outlive this   @throws GpuError
  explicit OverlayPainter(const Model& model);

  /// Updates nodes to the state, before anything is drawn.
  void follow(const OverlayStyle& style);
  /// Draws the surface in the colours of strain, in place of the tissue's. @param mesh  of look.surface
  void drawStrain(const OverlayStyle& style, const MeshView& mesh, const Pose& optical_from_tissue,
                  const Eigen::Matrix4f& clip_from_optical);
  /// Draws all others but the legend over the image. @param supersampling  of the image, for the width of lines
  void draw(const OverlayStyle& style, int supersampling, const Pose& optical_from_tissue,
            const Eigen::Matrix4f& clip_from_optical);
  /// Draws the scale of strain at the right of the image.
  void drawLegend(double strain_range);

 private:
  using Color = std::array<float, 4>;
  template <class DrawLines>
  void drawThrough(const Color& color, DrawLines drawLines);
  void drawSprings(const OverlayStyle& style);
  void drawSpikes(const gpu::Buffer<layout::vec4>& ends, const Color& color);
  void drawArrows(const OverlayStyle& style, const Pose& optical_from_tissue, const Eigen::Matrix4f& clip_from_optical);

  NodeOverlay nodes_;
  uint64_t capture_ = 0;  ///< capture of nodes_
  gpu::Program line_, strain_, arrow_, legend_;
  VertexArray mesh_inputs_, line_inputs_, arrow_inputs_, no_inputs_;
  gpu::Buffer<ToolVertex> arrow_vertices_;
  gpu::Buffer<uint32_t> arrow_indices_;
  size_t indices_per_arrow_ = 0;
};

}  // namespace viscera
