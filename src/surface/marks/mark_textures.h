// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "viscera/layout/types.h"
#include "viscera/surface/skin_marks.h"

namespace viscera {

/// Marks on the GPU, for shaders/draw/marks.glsl.
class MarkTextures {
 public:
  /// Sets the marks; null: none. Strokes are written only where they are others than the last ones. Needs a current
  /// context.
  void show(const std::shared_ptr<const VisibleMarks>& marks);
  bool any() const { return any_; }
  /// Binds the textures, and sets the uniforms of programs with feature MARKS.
  void bind() const;
  void set(const gpu::Program& program) const;

 private:
  std::shared_ptr<const std::vector<MarkStroke>> strokes_;
  std::shared_ptr<const VisibleMarks> marks_;
  gpu::Buffer<layout::vec4> segments_, styles_;
  gpu::Buffer<uint32_t> cells_;
  gpu::TexelView segments_view_, styles_view_, cells_view_;
  std::array<float, 4> space_{};   ///< xyz corner of the grid [m], w cells per metre
  std::array<float, 3> counts_{};  ///< of cells along each axis
  bool any_ = false;
};

}  // namespace viscera
