// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/cpu_solver.h"

#include "viscera/model/scene/scene.h"

namespace viscera {

CpuSolver::CpuSolver(const Model& model, const Scene& scene, const CpuSolverOptions& options)
    : CpuSolver(model, scene, planTicks(model, scene, options), options) {}

CpuSolver::CpuSolver(const Model& model, const Scene& scene, const TickPlan& plan, const CpuSolverOptions& options)
    : TissueStepper(model, scene, plan, std::make_unique<CpuBackend>(model, scene, plan, options)) {}

}  // namespace viscera
