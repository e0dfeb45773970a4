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
#include "viscera/solver/shown_thread.h"

namespace viscera {

/// How a thread, a needle or a clip is drawn.
struct ThreadLook {
  double radius_m;
  std::array<uint8_t, 4> color;  ///< sRGB, solid
  size_t nodes;                  ///< that it has
  size_t thread;                 ///< index in the scene, of a needle that of its thread; of clips 0
  ThreadPart part = ThreadPart::kThread;
  size_t most = 1;  ///< of them
};

/// Draws threads as tubes along their nodes, no thinner than a pixel and a half. With the shaders of tools.
class ThreadPainter {
 public:
  ThreadPainter(std::vector<ThreadLook> threads, const std::vector<std::string>& features);
  void lightFor(const CameraConfig& camera) { setLight(program_, camera); }  ///< what is drawn from now on
  /// Draws into the bound framebuffer.
  /// @param shown  of these threads, in pieces or whole
  /// @param pixel  its width at a distance of 1
  void draw(const ShownThreads& shown, const Pose& optical_from_tissue, const Eigen::Matrix4f& clip_from_optical,
            double pixel);
  /// With another program, in use: geometry.frag.
  void drawGeometry(const gpu::Program& program, const ShownThreads& shown, const Pose& optical_from_tissue,
                    const Eigen::Matrix4f& clip_from_optical, double pixel);

 private:
  template <class Before>
  void drawWith(const gpu::Program& program, const ShownThreads& shown, const Pose& optical_from_tissue,
                const Eigen::Matrix4f& clip_from_optical, double pixel, Before before);
  void shape(const ThreadLook& thread, const std::vector<Vector3d>& places_m, const Pose& optical_from_tissue,
             double pixel);

  std::vector<ThreadLook> threads_;
  gpu::Program program_;
  VertexArray inputs_;
  gpu::Buffer<ToolVertex> vertices_;  ///< of all threads, one after the other
  gpu::Buffer<uint32_t> indices_;     ///< of the longest
  // of the thread under way, optical frame
  std::vector<Vector3f> points_m_;
  std::vector<float> radii_m_;
  ToolShape tube_;
};

}  // namespace viscera
