// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "layout/overlay.h"
#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

/// Strain of the springs of each node. Owner of shaders/surface/overlay_nodes.comp.
class NodeStrains {
 public:
  enum class Mean { kOfSquares, kSigned };
  /// Needs a current context. @throws GpuError
  NodeStrains(const Model& model, Mean mean);

  /// Computes them for a state. Leaves its buffers bound for the kernels that follow.
  void follow(const StateView& state);
  const gpu::Buffer<layout::vec4>& nodes() const { return nodes_; }  ///< [slots] xyz m, w strain

 private:
  gpu::Buffer<layout::vec4> nodes_;
  gpu::Buffer<uint32_t> link_starts_;  ///< of networks
  gpu::Buffer<layout::OverlayLink> links_;
  gpu::Program position_;
};

}  // namespace viscera
