// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "layout/bindings.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/tissue/features.h"
#include "solver/tissue/substep.h"

namespace viscera {

/// Contacts of probes with springs on the surface, between their ends. Owner of shaders/solver/tools/edges.comp.
class EdgesPass {
 public:
  explicit EdgesPass(const FeatureSet& features);
  /// Binds the list of nodes. Call it before leapfrog.comp, which writes the list.
  void bind() const { nodes_.bindStorage(layout::kBindEdgeNodes); }
  /// Pushes the listed springs. Call it after leapfrog.comp; the buffers must be bound.
  void run(const LatticeBuffers& buffers, const Substep& step) const;

 private:
  gpu::Program program_;
  gpu::RawBuffer nodes_;
  uint32_t group_size_;
};

}  // namespace viscera
