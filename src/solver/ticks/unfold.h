// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "viscera/layout/tick_stats.h"
#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

/// Tissue that a tool has turned inside out stays so where springs hold it there; matter cannot. Nodes of whole cells
/// of lattices that are turned inside out at a corner, and those around them, go where a Laplace equation of
/// displacements, less the affine motion nearest to those of the nodes beyond, has them between these, as far around as
/// it takes until all such cells are upright; velocities likewise (docs/physics.md 3). Fixed and held nodes stay, and
/// so does what hangs at no other node.
/// @param state  changed only where fewer cells are turned inside out afterwards
/// @return nodes that were moved
size_t unfold(const Model& model, HostState& state);

/// When to look whether tissue stays folded: once it has been left alone for a while, after tools were at it.
class FoldWatch {
 public:
  static constexpr int kLooks = 3;  ///< after tools have left, while folds are found
  explicit FoldWatch(double tick_s);
  /// Of a good tick. @return whether it is time to look
  bool isDue(const layout::TickStats& stats);
  /// What looking has found: it is looked at again a while later, but not for ever.
  void found(size_t nodes);
  void reset() { looks_left_ = 0; }
  int waitTicks() const { return wait_ticks_; }
  int ticksLeft() const { return ticks_left_; }
  int looksLeft() const { return looks_left_; }
  template <class Archive>
  void persist(Archive& archive) {
    archive.value(looks_left_);
    archive.value(ticks_left_);
  }

 private:
  int wait_ticks_, ticks_left_ = 0, looks_left_ = 0;
};

}  // namespace viscera
