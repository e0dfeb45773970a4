// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "solver/contact/node_pairs.h"
#include "solver/cpu/text/contact_lists.h"

namespace viscera {

struct Scene;

class Archive;

/// Contacts between nodes within an implicit substep: who may touch whom, and what they do to each other
/// (shaders/solver/implicit/implicit_pairs.glsl) on the CPU. See solver/gpu/contact/node_pairs.h.
class CpuNodePairs {
 public:
  CpuNodePairs(const Model& model, const Scene& scene, const CpuLattice& lattice, const Parallel& parallel);

  /// Finds the pairs where the increments lead, and marks nodes that have some. @param increments  [slots]
  void find(CpuLattice& lattice, const Substep& step, glsl::vec4* increments);
  /// [nodes with pairs] slots, ascending; prescribed ones among them
  const std::vector<uint32_t>& slots() const { return paired_; }
  /// The state was written from outside: the last forces of contacts are forgotten.
  void restart();
  void persist(Archive& archive);
  /// Tells a kernel where they are.
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
