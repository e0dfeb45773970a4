// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/contact/node_pairs.h"
#include "solver/gpu/contact/collision_pass.h"

namespace viscera {

struct Scene;

/// Contacts between nodes within an implicit substep (shaders/solver/implicit/implicit_pairs.glsl): pairs that may
/// touch, found at the positions of the first iterate, and their storage. ImplicitSubstep applies their forces.
class NodePairs {
 public:
  NodePairs(const Model& model, const Scene& scene, const FeatureSet& features, const LatticeBuffers& buffers);

  void bind() const;
  /// Finds the pairs, and marks nodes with pairs. The increments must be bound.
  void find(const LatticeBuffers& buffers, const Substep& step) const;
  /// Clears the last forces of contacts after an external write to the state.
  void restart() { nodes_.clear(); }
  void persist(Archive& archive);
  /// Binds the pairs to a kernel, and sets the friction and restitution of contacts.
  void tell(const gpu::Program& program, const Substep& step) const;

 private:
  CollisionPass search_;
  CollisionConfig config_;
  mutable gpu::Buffer<uint32_t> words_;     ///< see layout::kBindPairWords and the bindings after it
  gpu::Buffer<layout::vec4> rows_, nodes_;  ///< [2 * ends], [3 * slots]
};

}  // namespace viscera
