// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/colours.h"
#include "solver/cpu/implicit_substep.h"

namespace viscera {

/// Vertex block descent on implicit Euler: shaders/solver/vbd.comp on the CPU, see solver/gpu/vbd_pass.h.
class CpuVbd : public CpuStepper {
 public:
  /// @param iterations  sweeps over all colours per substep   @param pairs  as CpuImplicitSubstep
  CpuVbd(const CpuLattice& lattice, const Parallel& parallel, int iterations, CpuNodePairs* pairs = nullptr);
  void run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) override;

  // The parts of a substep, for who does more between its sweeps.
  void begin(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) {
    implicit_.begin(lattice, step, motions);
  }
  void sweepAll(CpuLattice& lattice, const Substep& step);  ///< as often as run() does
  void end(CpuLattice& lattice, const Substep& step) { implicit_.end(lattice, step); }
  CpuImplicitSubstep& implicit() { return implicit_; }

 private:
  template <class Kernel>
  void sweep(CpuLattice& lattice, const Substep& step);

  CpuImplicitSubstep implicit_;
  const Parallel& parallel_;
  Coloured coloured_;
  int iterations_;
};

}  // namespace viscera
