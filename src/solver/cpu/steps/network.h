// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/steps/network_kernels.h"
#include "solver/cpu/store/parallel.h"
#include "solver/cpu/text/glsl_kernel.h"
#include "solver/cpu/text/near_links.h"

namespace viscera {

class Archive;

/// A probe in a substep: nodes that come into this sphere are looked at one by one (shaders/solver/tools/contact.glsl).
struct NodeReach {
  glsl::vec3 center_m;
  float radius_m;
};

/// Leapfrog, measurements and cuts of bodies with explicit connections: shaders/solver/step/leapfrog.comp,
/// measure.comp and cut_links.comp on the CPU. Leapfrog is a
/// SIMD kernel (network_kernels.h), the rest the shaders' text.
class CpuNetwork {
 public:
  CpuNetwork(const CpuLattice& lattice, const Parallel& parallel, const FeatureSet& features,
             const simd::Kernels& kernels);

  /// One substep of all of them, without contacts, from the current state into the other one.
  /// @param compensation  [6 * slots] of the lattice's kernels; empty without compensation
  void step(CpuLattice& lattice, const Substep& step, AlignedVector<float>& compensation);
  /// Slots of the nodes just stepped that are held, or within reach of a probe.
  /// @param reaches  of this substep
  const std::vector<uint32_t>& touched(CpuLattice& lattice, const std::vector<NodeReach>& reaches);
  /// Adds what they measure to what was measured of the others: energies, maxima and counts.
  void measure(CpuLattice& lattice, layout::TickStats& stats) const;
  /// Erases the springs that the swept blade crosses. @param spared  as of CpuCut::run()   @return how many
  uint32_t cut(CpuLattice& lattice, const layout::ToolMotion& motion, bool particles, const uint8_t* spared = nullptr);
  /// The state was written from outside: springs may have changed.
  void restart(const CpuLattice& lattice);

 private:
  const Parallel& parallel_;
  simd::NetworkGroups spread_rows_, step_rows_;
  bool dashpot_;
  NearLinks near_;
  simd::LinkRows rows_;
  AlignedVector<float> places_, speeds_;  ///< of NetworkJob
  std::vector<uint32_t> slots_, touched_;
};

}  // namespace viscera
