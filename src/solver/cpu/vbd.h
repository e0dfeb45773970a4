// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/colours.h"
#include "solver/cpu/implicit_substep.h"

namespace viscera {

/// Vertex block descent on implicit Euler: shaders/solver/vbd.comp on the CPU, see gpu/vbd_pass.h.
class CpuVbd : public CpuStepper {
 public:
  /// @param iterations  sweeps over all colours per substep   @param pairs  as CpuImplicitSubstep
  CpuVbd(const CpuLattice& lattice, const Parallel& parallel, int iterations, CpuNodePairs* pairs = nullptr);
  void run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) override;

 private:
  template <class Kernel>
  void sweep(CpuLattice& lattice, const Substep& step);

  CpuImplicitSubstep implicit_;
  const Parallel& parallel_;
  Coloured coloured_;
  int iterations_;
};

}  // namespace viscera
