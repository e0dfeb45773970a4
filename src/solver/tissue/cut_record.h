// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/tissue/features.h"
#include "solver/tissue/joined_network.h"

namespace viscera {

/// The record of cuts of all lattices, CutSprings::axial_cut. Kernels write what implicit lattices have of it
/// (shaders/solver/tools/cut.comp); explicit ones have it in spring_cut, by spring, put together on the host.
class CutRecord {
 public:
  /// @param network  of the model
  CutRecord(const Model& model, const JoinedNetwork& network, const FeatureSet& features);
  /// [3 * slots]; 0 where no tool cuts or no body is a lattice.
  size_t size() const { return size_; }
  /// Puts in what explicit lattices have. @param spring_cut  [springs] as in CutSprings   @param axial_cut  [size()]
  void addExplicit(const std::vector<float>& spring_cut, std::vector<float>& axial_cut) const;

 private:
  struct Place {
    uint32_t spring, at;  ///< in spring_cut and in axial_cut
    bool forward;         ///< leads along its axis from a to b
  };
  size_t size_ = 0;
  std::vector<Place> places_;
};

}  // namespace viscera
