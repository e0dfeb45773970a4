// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "gpu/program.h"
#include "render/seen_target.h"
#include "render/vertex_array.h"
#include "viscera/render/camera.h"

namespace viscera {

/// Makes the image of what has been seen of tissue: pixels whose samples saw one surface are lit once, those at edges
/// sample by sample. Owner of shaders/draw/whole.vert, seen_parts.frag, seen_light.frag, over.frag.
class SeenLight {
 public:
  /// Slope to the image's plane, beyond which samples beside each other are taken to see several surfaces.
  static constexpr float kSteepest = 10;

  /// @param features  GRAIN, DETAIL
  explicit SeenLight(const std::vector<std::string>& features);
  /// The programs that light, for uniforms of their own.
  std::array<const gpu::Program*, 2> programs() const { return {&one_, &several_}; }
  /// Textures of tissue are bound. Leaves the image as the place to draw to, with nothing to be tested.
  /// @param background  linear
  /// @param pause  is called between passes, where it is set
  void light(const SeenTarget& target, const CameraConfig& camera, const Pose& optical_from_tissue,
             const float (&background)[4], const std::function<void()>& pause) const;
  /// Puts what was drawn over the tissue there.
  void putOver(const SeenTarget& target) const;

 private:
  gpu::Program parts_, one_, several_, over_;
  VertexArray nothing_;
};

}  // namespace viscera
