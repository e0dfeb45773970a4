// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "model/fracture/tearing.h"
#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/store/cpu_lattice.h"

namespace viscera {

/// Tissue that tears by energy (docs/cutting.md 8): springs that are stretched too far soften, and part. Looks only
/// where the tissue was strained at the end of the last tick. On one thread.
class CpuTearing {
 public:
  explicit CpuTearing(const Model& model);
  /// Before a tick. @param stats  [bricks] as measured at the end of the last one
  void beginTick(const CpuLattice& lattice, const std::vector<simd::BrickStats>& stats);
  /// After a substep. @return springs that have parted in it
  uint32_t run(CpuLattice& lattice);
  /// In which springs are looked at in this tick.
  const std::vector<uint32_t>& bricks() const { return bricks_; }

 private:
  template <class Kernel>
  uint32_t stretch(CpuLattice& lattice, Kernel& kernel, uint32_t slot, const TearLaw& law);
  template <class Kernel>
  void refresh(CpuLattice& lattice, Kernel& kernel);

  std::vector<std::optional<TearLaw>> laws_;  ///< [bodies]
  std::vector<uint32_t> bricks_;
  std::vector<uint32_t> changed_, cells_;  ///< slots whose springs have softened, of cells with such
};

}  // namespace viscera
