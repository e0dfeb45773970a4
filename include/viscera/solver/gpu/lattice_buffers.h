// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/gpu/buffer.h"
#include "viscera/model/model.h"

namespace viscera {

/// The lattices of all bodies and their state in GPU memory: what every kernel of the solver works on.
struct LatticeBuffers {
  /// @param bodies  [bodies] material constants   @param with_tools  allocate what only tools need
  LatticeBuffers(const Model& model, const std::vector<layout::BodyParams>& bodies, bool with_tools);

  /// Binds what all kernels share, with the current state as input and the other as output.
  void bind() const;
  /// What was output becomes the current state.
  void swap() { current = 1 - current; }
  /// Rest state, whole springs, nothing held.
  void reset();

  size_t active_count = 0, slot_count = 0;
  gpu::Buffer<uint32_t> active;               ///< [active]
  gpu::Buffer<layout::Brick> bricks;          ///< [bricks]
  gpu::Buffer<layout::BodyParams> bodies;     ///< [bodies]
  gpu::Buffer<layout::NodeBits> nodes;        ///< [slots]
  gpu::Buffer<layout::vec4> displacement[2];  ///< [slots] m
  gpu::Buffer<layout::vec4> velocity[2];      ///< [slots] m/s
  gpu::Buffer<layout::vec4> grab_offsets;     ///< [slots] m, stylus frame
  gpu::Buffer<layout::vec4> impulses;         ///< [kMaxStyluses * slots] N s
  gpu::Buffer<layout::TickStats> stats;       ///< [1]
  int current = 0;

 private:
  gpu::TexelView brick_texels_, displacement_texels_[2], velocity_texels_[2];
  std::vector<layout::NodeBits> whole_nodes_;
};

}  // namespace viscera
