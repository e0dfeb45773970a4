// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/gpu/gpu_backend.h"
#include "solver/ticks/ticks.h"

namespace viscera {

struct Scene;

/// The solver whose state lives on the GPU: ticks on a GpuBackend.
class GpuSolver final : public Ticks {
 public:
  /// @param model  must outlive the solver
  /// @throws GpuError  shaders, memory;  SceneError  substeps (planSubsteps), parts (strengths)
  GpuSolver(const Model& model, const Scene& scene, const GpuSolverOptions& options = {});

  StateView state() const { return *stateOnGpu(); }
  /// Times that the host had to wait for measurements: of the tick before, where a governor judges it, or where none
  /// governs and the GPU is more than three ticks behind.
  uint64_t waits() const { return gpu().waits(); }
  /// [bricks] 1 where awake, for the next substep; waits.
  std::vector<uint8_t> awake() const { return gpu().awake(); }
  size_t awakeBricks() const;  ///< how many of them
  size_t bricks() const { return gpu().bricks(); }
  bool resting() const { return gpu().resting(); }  ///< the last tick was known to change nothing, and not carried out

 private:
  GpuSolver(const Model& model, const Scene& scene, const TickPlan& plan, const GpuSolverOptions& options);
  const GpuBackend& gpu() const { return static_cast<const GpuBackend&>(ticked()); }
};

}  // namespace viscera
