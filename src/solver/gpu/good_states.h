// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "gpu/program.h"
#include "solver/gpu/buffers/lattice_buffers.h"

namespace viscera {

class Archive;

/// Ring of the last good states on the GPU: displacements and velocities. Cuts are not undone.
/// Owner of shaders/solver/step/save_state.comp.
class GoodStates {
 public:
  /// @param depth  number of states kept, > 0
  GoodStates(size_t slots, int depth);
  void clear() { kept_ = 0; }
  /// Saves the current state in place of the oldest one.
  /// @param same  the state equals the one saved last: it is copied only until the whole ring holds it
  void save(const LatticeBuffers& buffers, bool same = false);
  /// Restores the state saved `back` saves before the last one (0: the last), or the oldest one if there are fewer, and
  /// discards the younger ones. If even the oldest one is not old enough, velocities become zero as a last resort. At
  /// least one state must have been saved.
  void restore(LatticeBuffers& buffers, int back);

  void persist(Archive& archive);

  /// Binds the last saved state, for GuardPass.
  void bindLast() const;

 private:
  struct State {
    gpu::Buffer<layout::vec4> displacement, velocity;
  };
  void keep(const LatticeBuffers& buffers, State& state) const;
  const State& last() const { return ring_[(static_cast<size_t>(next_) + ring_.size() - 1) % ring_.size()]; }
  std::vector<State> ring_;
  std::optional<gpu::Program> saves_;  ///< copies states; without it the driver does
  int next_ = 0, kept_ = 0, same_ = 0;
};

}  // namespace viscera
