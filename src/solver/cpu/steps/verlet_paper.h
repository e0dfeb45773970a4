// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/cpu/steps/cpu_device.h"

namespace viscera {

/// Position Verlet as printed in VR05 and GW: shaders/solver/step/verlet_paper.comp in C++; see
/// solver/gpu/steps/verlet_paper_pass.h.
class CpuVerletPaper : public CpuStepper {
 public:
  CpuVerletPaper(const CpuLattice& lattice, const Parallel& parallel);
  void run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) override;
  void persist(Archive& archive, CpuLattice& lattice) override;

 private:
  template <class Kernel>
  Kernel kernel(CpuLattice& lattice, const Substep& step);
  template <class Kernel>
  void advance(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions);

  const Parallel& parallel_;
  std::vector<glsl::vec4> positions_[2];  ///< [slots] m: x at current_, x_prev at the other, which x+ overwrites
  int current_ = 0;
  float last_dt_s_ = 0;
};

}  // namespace viscera
