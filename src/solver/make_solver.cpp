// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/make_solver.h"

#include "model/scene/integrators.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/gpu/gpu_solver.h"
#include "solver/multigrid/equilibrium.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

/// A solver in the state that solver.start asks for.
std::unique_ptr<Solver> started(std::unique_ptr<Ticks> solver, const Model& model, const Scene& scene,
                                const std::shared_ptr<ThreadPool>& threads) {
  SettleReport report;
  if (scene.solver.start == SolverStart::kEquilibrium) solver->startFrom(equilibriumOf(model, scene, report, threads));
  return solver;
}

}  // namespace

Backend chooseBackend(const SolverConfig& config, const gpu::Context* context) {
  if (config.backend != Backend::kAuto) return config.backend;
  if (traitsOf(config.integrator).cpu_only) return Backend::kCpu;
  return !context || context->isSoftware() ? Backend::kCpu : Backend::kGpu;
}

std::string backendNote(const SolverConfig& config, const gpu::Context* context, const Solver& solver) {
  const std::string taken = "stepped by: " + solver.backend();
  if (config.backend != Backend::kAuto) return taken + ", as solver.backend asks";
  if (traitsOf(config.integrator).cpu_only) return taken + ", as solver.integrator steps on the CPU only";
  if (!context) return taken + ", as there is no OpenGL context";
  return taken + (context->isSoftware() ? ", as OpenGL is a software rasteriser: " : ", as OpenGL has a GPU: ") +
         context->renderer();
}

std::unique_ptr<Solver> makeSolver(const Model& model, const Scene& scene, const gpu::Context* context,
                                   const std::shared_ptr<ThreadPool>& threads) {
  if (chooseBackend(scene.solver, context) == Backend::kCpu) {
    CpuSolverOptions options;
    options.threads = threads;
    return started(std::make_unique<CpuSolver>(model, scene, options), model, scene, threads);
  }
  if (!context) throw GpuError("solver.backend: gpu needs an OpenGL context, and there is none: use cpu or auto");
  return started(std::make_unique<GpuSolver>(model, scene), model, scene, threads);
}

}  // namespace viscera
