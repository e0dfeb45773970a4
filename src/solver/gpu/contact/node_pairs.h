// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/contact/node_pairs.h"
#include "solver/gpu/contact/collision_pass.h"

namespace viscera {

struct Scene;

/// Contacts between nodes within an implicit substep (shaders/solver/implicit/implicit_pairs.glsl): who may touch whom,
/// found where the first iterate leads, and their memory. What they do is in ImplicitSubstep.
class NodePairs {
 public:
  NodePairs(const Model& model, const Scene& scene, const FeatureSet& features, const LatticeBuffers& buffers);

  void bind() const;
  /// Finds the pairs, and marks nodes that have some. The increments must be bound.
  void find(const LatticeBuffers& buffers, const Substep& step) const;
  /// The state was written from outside: the last forces of contacts are forgotten.
  void restart() { nodes_.clear(); }
  void persist(Archive& archive);
  /// Tells a kernel where they are, and how contacts rub and bounce.
  void tell(const gpu::Program& program, const Substep& step) const;

 private:
  CollisionPass search_;
  CollisionConfig config_;
  mutable gpu::Buffer<uint32_t> words_;     ///< see layout::kBindPairWords, and so on
  gpu::Buffer<layout::vec4> rows_, nodes_;  ///< [2 * ends], [3 * slots]
};

}  // namespace viscera
