// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/gpu/contact/node_pairs.h"
#include "solver/gpu/steps/stepper.h"

namespace viscera {

/// Start and end of a substep of implicit Euler and the increments du = u+ - u in between, which pd iterates
/// (shaders/solver/implicit/implicit.glsl has the equations). Owner of shaders/solver/implicit/*.comp.
class ImplicitSubstep {
 public:
  /// @param iterations  at most, in a substep
  /// @param pairs  contacts between nodes that are part of the solution; null: none
  ImplicitSubstep(const FeatureSet& features, const LatticeBuffers& buffers, int iterations,
                  const NodePairs* pairs = nullptr);

  /// First iterate: held nodes are where their tools have them, none is in a probe or an obstacle; the others at the
  /// best share of the motion without forces, that of 0, 1/2, 3/4, 1 with the lowest incremental potential.
  void begin(const LatticeBuffers& buffers, const Substep& step);
  /// State = displacement + last iterate, v = du/dt; tools, sleep. The last iterate is taken in the largest share of 0,
  /// 1/2, 3/4, 1 that does not end with more kinetic + elastic energy than there was before the substep and gravity
  /// added, so energy cannot grow, whatever the state, dt and the number of iterations. Where tools act, which may
  /// bring energy in, only the incremental potential must not be above that of no motion. Who holds or touches nodes
  /// gives them what their balance of forces at the end of the substep lacks.
  void end(const LatticeBuffers& buffers, const Substep& step) const;

  /// The next iterate is where the last but one was; swap() makes it the current one.
  void swap();
  /// Forces and majorisers of the cells in the current iterate, where there are any, for the iteration that follows.
  void updateVolumes(const LatticeBuffers& buffers, const Substep& step, int iteration) const;

  /// The part of a sweep that moves nodes which may touch others: all of them together. After the rest of it.
  void movePairs(const LatticeBuffers& buffers, const Substep& step, int iteration) const;

  /// Sets what all kernels of a substep are told; for a program compiled with defines(features, step.tools).
  void tell(const gpu::Program& program, const LatticeBuffers& buffers, const Substep& step) const;
  /// @param tools  probes and held nodes are about, which the tissue's obstacles always are
  static std::vector<std::string> defines(const FeatureSet& features, bool tools = false);

  gpu::Buffer<uint32_t> guard;  ///< [1 + 2 iterations], see shaders/solver/implicit/implicit.glsl

 private:
  void bindIncrements() const;
  void runStage(const gpu::Program& stage, const LatticeBuffers& buffers, const Substep& step) const;
  void keepBestShare(const LatticeBuffers& buffers, const Substep& step, bool bound_energy) const;
  void chooseShare(const LatticeBuffers& buffers, bool bound_energy) const;

  gpu::Program begin_[2], guess_[2], scale_[2], end_[2];  ///< without and with tools
  gpu::Program fold_, cells_;
  gpu::Program pull_[2], place_[2], meet_;   ///< of pairs
  gpu::Buffer<layout::vec4> increments_[2];  ///< [slots] xyz m; w 1 where prescribed; this iterate and the last
  gpu::TexelView increment_texels_[2];
  gpu::Buffer<layout::vec4> contacts_;  ///< [3 * rows * slots], see shaders/solver/implicit/implicit_contact.glsl
  gpu::Buffer<layout::vec4> energies_;  ///< [2 * (active + tree)] J
  int current_ = 0;
  const NodePairs* pairs_;
  uint32_t group_size_, contact_rows_;
  bool obstacles_;
};

}  // namespace viscera
