// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/cpu/cpu_backend.h"
#include "solver/ticks/tissue_stepper.h"

namespace viscera {

struct Scene;

/// The solver with its state in host memory: TissueStepper on a CpuBackend.
class CpuSolver final : public TissueStepper {
 public:
  /// @param model  must outlive the solver
  /// @throws SceneError  substeps (planSubsteps), parts (strengths), unknown simd
  CpuSolver(const Model& model, const Scene& scene, const CpuSolverOptions& options = {});

  size_t awakeBricks() const { return cpu().awakeBricks(); }    ///< in the last substep
  std::vector<uint8_t> awake() const { return cpu().awake(); }  ///< [bricks] 1 where awake
  size_t bricks() const { return cpu().bricks(); }

 private:
  CpuSolver(const Model& model, const Scene& scene, const TickPlan& plan, const CpuSolverOptions& options);
  const CpuBackend& cpu() const { return static_cast<const CpuBackend&>(ticked()); }
};

}  // namespace viscera
