// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/program.h"
#include "solver/contact/tool_target.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/tissue/features.h"

namespace viscera {

/// Takes hold of nodes around a stylus tip and lets them go (VR05 2.7.2). Owner of shaders/solver/tools/grab.comp.
class GrabPass {
 public:
  explicit GrabPass(const FeatureSet& features);
  /// @param stylus  index, < kMaxStyluses   @param pose  its own, tissue frame   @param radius_m  the grip's reach
  void takeHold(const LatticeBuffers& buffers, uint32_t stylus, const Pose& pose, double radius_m) const;
  /// What the stylus gave in the tick is read from the stats, where they are bound.
  void letGo(const LatticeBuffers& buffers, uint32_t stylus, const Release& release) const;

 private:
  gpu::Program take_, release_;
  uint32_t group_size_;
};

}  // namespace viscera
