// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/tissue/features.h"
#include "solver/tissue/joined_network.h"

namespace viscera {

/// The record of cuts of all lattices, CutSprings::axial_cut. Kernels write the entries of implicit lattices
/// (shaders/solver/tools/cut.comp). Explicit lattices have theirs in spring_cut, by spring; the host merges them.
class CutRecord {
 public:
  /// @param network  of the model
  CutRecord(const Model& model, const JoinedNetwork& network, const FeatureSet& features);
  /// Returns [3 * slots]; 0 if no tool cuts or no body is a lattice.
  size_t size() const { return size_; }
  /// Adds the entries of explicit lattices. @param spring_cut  [springs] as in CutSprings   @param axial_cut  [size()]
  void addExplicit(const std::vector<float>& spring_cut, std::vector<float>& axial_cut) const;

 private:
  struct Entry {
    uint32_t spring, at;  ///< indices into spring_cut and into axial_cut
    bool forward;         ///< the spring points along its axis from a to b
  };
  size_t size_ = 0;
  std::vector<Entry> entries_;
};

}  // namespace viscera
