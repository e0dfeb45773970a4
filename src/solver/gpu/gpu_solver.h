// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/gpu/gpu_backend.h"
#include "solver/ticks/tissue_stepper.h"

namespace viscera {

struct Scene;

/// The solver with its state on the GPU: TissueStepper on a GpuBackend.
class GpuSolver final : public TissueStepper {
 public:
  /// @param model  must outlive the solver
  /// @throws GpuError  shaders, memory;  SceneError  substeps (planSubsteps), parts (strengths)
  GpuSolver(const Model& model, const Scene& scene, const GpuSolverOptions& options = {});

  StateView state() const { return *stateOnGpu(); }
  /// Returns how often the host had to wait for measurements: for those of the last tick, if there is a stability
  /// monitor; without one, only if the GPU is more than three ticks behind.
  uint64_t waits() const { return gpu().waits(); }
  /// Returns [bricks] 1 where awake, for the next substep. Waits for the GPU.
  std::vector<uint8_t> awake() const { return gpu().awake(); }
  size_t awakeBricks() const;  ///< number of awake bricks; waits for the GPU
  size_t bricks() const { return gpu().bricks(); }
  bool resting() const { return gpu().resting(); }  ///< the last tick was skipped, as it would have changed nothing

 private:
  GpuSolver(const Model& model, const Scene& scene, const TickPlan& plan, const GpuSolverOptions& options);
  const GpuBackend& gpu() const { return static_cast<const GpuBackend&>(ticked()); }
};

}  // namespace viscera
