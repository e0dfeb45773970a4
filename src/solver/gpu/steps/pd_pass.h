// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/gpu/steps/implicit_substep.h"
#include "solver/tissue/jacobi.h"

namespace viscera {

/// PD-Jacobi in majorise-minimise form on implicit Euler (physics.md 2), with Chebyshev acceleration on request: where
/// that goes wrong the rest of the substep starts again without it, which the GPU decides.
/// Owner of shaders/solver/implicit/pd.comp.
class PdPass : public Stepper {
 public:
  PdPass(const FeatureSet& features, const LatticeBuffers& buffers, const PdOptions& options,
         const NodePairs* pairs = nullptr);
  void run(LatticeBuffers& buffers, const Substep& step) override;

  /// Bound on the spectral radius of the plain iteration (jacobiRadius).
  double spectralRadius(double dt_s) const;
  /// Largest step of a node per iteration of the last substep, before acceleration [m]. Waits for the GPU.
  std::vector<float> changes() const;
  /// Did the last substep give its acceleration up? Waits for the GPU.
  bool gaveUp() const;

 private:
  void findRates(const FeatureSet& features, const LatticeBuffers& buffers);

  ImplicitSubstep implicit_;
  gpu::Program sweep_[2];  ///< without and with tools
  PdOptions options_;
  double stiffness_rate_per_s2_ = 0, damping_rate_per_s_ = 0;  ///< max of (sum of k + volume)/m, of (sum of c)/m
  uint32_t group_size_;
};

}  // namespace viscera
