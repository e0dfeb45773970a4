// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "model/fracture/tearing.h"
#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/state/cpu_lattice.h"

namespace viscera {

/// Tissue that tears by energy (docs/physics.md 12): springs that are stretched too far soften, and finally tear.
/// Checks only bricks that were strained at the end of the last tick. Runs on one thread.
class CpuTearing {
 public:
  explicit CpuTearing(const Model& model);
  /// Prepares a tick.
  /// @param stats  [bricks] as measured at the end of the last one
  void beginTick(const CpuLattice& lattice, const std::vector<simd::BrickStats>& stats);
  /// Softens and tears springs after a substep.
  /// @return number of springs that have torn in it
  uint32_t run(CpuLattice& lattice);
  /// Returns the bricks with springs that are checked in this tick.
  const std::vector<uint32_t>& bricks() const { return bricks_; }

 private:
  template <class Kernel>
  uint32_t stretch(CpuLattice& lattice, Kernel& kernel, uint32_t slot, const TearLaw& law);
  template <class Kernel>
  void refresh(CpuLattice& lattice, Kernel& kernel);

  std::vector<std::optional<TearLaw>> laws_;  ///< [bodies]
  std::vector<uint32_t> bricks_;
  std::vector<uint32_t> changed_, cells_;  ///< slots with softened springs, and cells with such springs
};

}  // namespace viscera
