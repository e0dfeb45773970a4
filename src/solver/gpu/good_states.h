// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "gpu/program.h"
#include "solver/gpu/buffers/lattice_buffers.h"

namespace viscera {

class Archive;

/// Ring of the last good states, on the GPU: displacements and velocities. Cuts are not undone.
/// Owner of shaders/solver/step/save_state.comp.
class GoodStates {
 public:
  /// @param depth  states that are kept, > 0
  GoodStates(size_t slots, int depth);
  void clear() { kept_ = 0; }
  /// Keeps the current state; the oldest is forgotten. @param same  it is the one that was saved last: copied only
  /// until all that is kept is that one
  void save(const LatticeBuffers& buffers, bool same = false);
  /// Puts back the state saved `back` saves before the last one (0: the last), or the oldest there is, and forgets the
  /// younger ones. At the oldest, velocities become zero: nothing else is left to try. One must have been saved.
  void restore(LatticeBuffers& buffers, int back);

  void persist(Archive& archive);

  /// Binds the state saved last, for GuardPass.
  void bindLast() const;

 private:
  struct State {
    gpu::Buffer<layout::vec4> displacement, velocity;
  };
  void keep(const LatticeBuffers& buffers, State& state) const;
  const State& last() const { return ring_[(static_cast<size_t>(next_) + ring_.size() - 1) % ring_.size()]; }
  std::vector<State> ring_;
  std::optional<gpu::Program> saves_;  ///< what copies; without it the driver does
  int next_ = 0, kept_ = 0, same_ = 0;
};

}  // namespace viscera
