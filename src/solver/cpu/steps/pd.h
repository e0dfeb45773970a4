// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/cpu/steps/implicit_substep.h"
#include "solver/tissue/jacobi.h"

namespace viscera {

/// PD-Jacobi in majorise-minimise form on implicit Euler: shaders/solver/implicit/pd.comp on the CPU, see
/// solver/gpu/steps/pd_pass.h.
class CpuPd : public CpuStepper {
 public:
  /// @param pairs  as CpuImplicitSubstep
  CpuPd(CpuLattice& lattice, const Parallel& parallel, const PdOptions& options, CpuNodePairs* pairs = nullptr);
  void run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) override;

  /// Bound on the spectral radius of the plain iteration (jacobiRadius).
  double spectralRadius(double dt_s) const;
  /// Largest step of a node per iteration of the last substep, before acceleration [m].
  std::vector<float> changes() const;
  /// Did the last substep give its acceleration up?
  bool gaveUp() const;

 private:
  void findRates(CpuLattice& lattice);
  template <class Sweep>
  void sweep(CpuLattice& lattice, const Substep& step, int iteration, double weight);

  CpuImplicitSubstep implicit_;
  const Parallel& parallel_;
  PdOptions options_;
  double stiffness_rate_per_s2_ = 0, damping_rate_per_s_ = 0;  ///< max of (sum of k + volume)/m, of (sum of c)/m
};

}  // namespace viscera
