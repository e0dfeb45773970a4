// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/make_solver.h"

#include "model/fracture/tearing.h"
#include "model/fracture/toughness.h"
#include "model/scene/integrators.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/gpu/gpu_solver.h"
#include "solver/integrator_choice.h"
#include "solver/multigrid/steps/equilibrium.h"
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

std::unique_ptr<Ticks> ticksOf(const Model& model, const Scene& scene, Backend backend,
                               const std::shared_ptr<ThreadPool>& threads) {
  if (backend != Backend::kCpu) return std::make_unique<GpuSolver>(model, scene);
  CpuSolverOptions options;
  options.threads = threads;
  return std::make_unique<CpuSolver>(model, scene, options);
}

}  // namespace

Backend chooseBackend(const Scene& scene, const gpu::Context* context) {
  const SolverConfig& config = scene.solver;
  if (config.backend != Backend::kAuto) return config.backend;
  if (traitsOf(config.integrator).prefers_cpu || resistsBlades(scene) || tears(scene)) return Backend::kCpu;
  return !context || context->isSoftware() ? Backend::kCpu : Backend::kGpu;
}

std::string backendNote(const Scene& scene, const gpu::Context* context, const Solver& solver,
                        const std::string& choice) {
  const SolverConfig& config = scene.solver;
  const std::string taken = (choice.empty() ? "" : "integrator: " + choice + "; ") + solver.backend();
  if (config.backend != Backend::kAuto) return taken + ", as solver.backend asks";
  if (traitsOf(config.integrator).prefers_cpu) return taken + ", as solver.integrator is measured on the CPU only";
  if (resistsBlades(scene))
    return taken + ", as tissue that resists blades (material.cut) would have a GPU waited for in every substep";
  if (tears(scene)) return taken + ", as only there tissue tears (material.tear)";
  if (!context) return taken + ", as there is no OpenGL context";
  return taken + (context->isSoftware() ? ", as OpenGL is a software rasteriser: " : ", as OpenGL has a GPU: ") +
         context->renderer();
}

std::unique_ptr<Solver> makeSolver(const Model& model, const Scene& scene, const gpu::Context* context,
                                   const std::shared_ptr<ThreadPool>& threads, std::string* choice) {
  const Backend backend = chooseBackend(scene, context);
  if (backend != Backend::kCpu && !context)
    throw GpuError("solver.backend: gpu needs an OpenGL context, and there is none: use cpu or auto");
  const auto tell = [&](const std::string& reason, Integrator integrator) {
    const std::string note = thinProbeNote(model, scene, integrator);
    if (choice) *choice = reason + (reason.empty() || note.empty() ? "" : "; ") + note;
  };
  if (scene.solver.integrator != Integrator::kAuto) {
    tell("", scene.solver.integrator);
    return started(ticksOf(model, scene, backend, threads), model, scene, threads);
  }
  const IntegratorChoice found = chooseIntegrator(model, scene, backend, threads);
  tell(found.reason, found.integrator);
  Scene chosen = scene;
  chosen.solver.integrator = found.integrator;
  return started(ticksOf(model, chosen, backend, threads), model, chosen, threads);
}

}  // namespace viscera
