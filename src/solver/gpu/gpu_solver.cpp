// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/gpu_solver.h"

#include "gpu/program.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

/// Returns a backend after the driver has compiled its kernels.
std::unique_ptr<GpuBackend> backendOf(const Model& model, const Scene& scene, const TickPlan& plan,
                                      const GpuSolverOptions& options) {
  const gpu::MadePrograms made;
  auto out = std::make_unique<GpuBackend>(model, scene, plan, options);
  made.require();
  return out;
}

}  // namespace

GpuSolver::GpuSolver(const Model& model, const Scene& scene, const GpuSolverOptions& options)
    : GpuSolver(model, scene, planTicks(model, scene, options), options) {}

GpuSolver::GpuSolver(const Model& model, const Scene& scene, const TickPlan& plan, const GpuSolverOptions& options)
    : TissueStepper(model, scene, plan, backendOf(model, scene, plan, options)) {}

size_t GpuSolver::awakeBricks() const {
  size_t count = 0;
  for (const uint8_t awake : gpu().awake()) count += awake;
  return count;
}

}  // namespace viscera
