// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "gpu/buffer.h"
#include "solver/tissue/joined_lattice.h"
#include "viscera/layout/types.h"
#include "viscera/model/model.h"

namespace viscera {

/// Second derivatives from rows of nodes for cells in thin walls (physics.md 1, Thin walls); feature walls.
struct WallBuffers {
  WallBuffers() = default;
  WallBuffers(const Model& model, const JoinedMoments& moments);
  void bind() const;

  gpu::Buffer<uint32_t> nodes;      ///< [corners of cells in thin walls] slots, ascending
  gpu::Buffer<layout::vec4> rows;   ///< [3 * slots] second differences over h, in planes; see rows.comp
  gpu::Buffer<layout::vec4> pulls;  ///< [9 * slots] J, in planes; see cell_forces.comp

 private:
  gpu::TexelView row_texels_, pull_texels_;
};

}  // namespace viscera
