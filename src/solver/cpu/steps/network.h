// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/cpu/kernels/glsl_kernel.h"
#include "solver/cpu/kernels/near_links.h"
#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/state/parallel.h"
#include "solver/cpu/steps/network_kernels.h"

namespace viscera {

class Archive;

/// Leapfrog, measurements and cuts of bodies with explicit connections: shaders/solver/step/leapfrog.comp, measure.comp
/// and cut_links.comp on the CPU. Leapfrog is a SIMD kernel (network_kernels.h), the rest is the shaders' text.
class CpuNetwork {
 public:
  CpuNetwork(const CpuLattice& lattice, const Parallel& parallel, const FeatureSet& features,
             const simd::Kernels& kernels);

  /// Makes one substep of all these bodies, without contacts, from the current state to the other one.
  /// @param compensation  [6 * slots] of the lattice's kernels; empty without compensation
  void step(CpuLattice& lattice, const Substep& step, AlignedVector<float>& compensation);
  /// Returns the slots of the nodes just stepped that are held or within reach of a probe or a shaft.
  /// @param reaches  of this substep
  const std::vector<uint32_t>& touched(CpuLattice& lattice, const std::vector<simd::Reach>& reaches);
  /// Adds the measurements of these bodies to those of the others: energies, maxima and counts.
  void measure(CpuLattice& lattice, layout::TickStats& stats) const;
  /// Removes the springs that the swept blade crosses.
  /// @param spared  as for CpuCut::run()
  /// @return number of springs cut
  uint32_t cut(CpuLattice& lattice, const layout::ToolMotion& motion, bool particles, const uint8_t* spared = nullptr);
  /// Updates the springs after an external write to the state.
  void restart(const CpuLattice& lattice);

 private:
  const Parallel& parallel_;
  simd::NetworkGroups spread_rows_, step_rows_;
  bool dashpot_;
  NearLinks near_;
  simd::LinkRows rows_;
  AlignedVector<float> positions_, speeds_;  ///< as in NetworkJob
  std::vector<uint32_t> slots_, touched_;
};

}  // namespace viscera
