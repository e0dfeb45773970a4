// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/program.h"
#include "solver/contact/tool_port.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/tissue/features.h"

namespace viscera {

/// Kernel that grips nodes around a stylus tip and releases them (VR05 2.7.2).
/// Owner of shaders/solver/tools/grab.comp.
class GrabPass {
 public:
  explicit GrabPass(const FeatureSet& features);
  /// Grips nodes.
  /// @param stylus  index, < kMaxStyluses
  /// @param pose  of the stylus, tissue frame
  /// @param radius_m  reach of the grip
  void takeHold(const LatticeBuffers& buffers, uint32_t stylus, const Pose& pose, double radius_m) const;
  /// Releases nodes. The impulse of the stylus in the tick is read from the stats, which must be bound.
  void letGo(const LatticeBuffers& buffers, uint32_t stylus, const Release& release) const;

 private:
  gpu::Program take_, release_;
  uint32_t group_size_;
};

}  // namespace viscera
