// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "solver/contact/node_pairs.h"
#include "solver/cpu/kernels/contact_lists.h"

namespace viscera {

struct Scene;

class Archive;

/// Contacts between nodes within an implicit substep on the CPU: which nodes may touch, and the forces between them
/// (shaders/solver/implicit/implicit_pairs.glsl). See solver/gpu/contact/node_pairs.h.
class CpuNodePairs {
 public:
  CpuNodePairs(const Model& model, const Scene& scene, const CpuLattice& lattice, const Parallel& parallel);

  /// Finds the pairs at the positions after the increments, and marks nodes with pairs.
  /// @param increments  [slots]
  void find(CpuLattice& lattice, const Substep& step, glsl::vec4* increments);
  /// Returns the slots of nodes with pairs, ascending, including prescribed ones.
  const std::vector<uint32_t>& slots() const { return paired_; }
  /// Clears the last forces of contacts after an external write to the state.
  void restart();
  void persist(Archive& archive);
  /// Binds the pairs to a kernel.
  void tell(glsl::PairBuffers& kernel, const Substep& step);

 private:
  template <class Kernel>
  Kernel kernel(CpuLattice& lattice, const Substep& step, glsl::vec4* increments);

  const Parallel& parallel_;
  CollisionConfig config_;
  float cell_m_;
  std::vector<layout::vec4> influences_;  ///< bodyInfluences()
  std::vector<float> touch_depths_;       ///< touchDepths()
  std::vector<glsl::vec4> contacts_;      ///< [slots] as layout::kBindContacts
  std::vector<uint32_t> words_, paired_;
  std::vector<glsl::vec4> rows_, node_pairs_;
  ContactLists lists_;
};

}  // namespace viscera
