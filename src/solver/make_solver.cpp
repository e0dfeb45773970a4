// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/make_solver.h"

#include "math/number_text.h"
#include "model/fracture/tearing.h"
#include "model/fracture/toughness.h"
#include "model/scene/integrators.h"
#include "model/scene/structure_rules.h"
#include "model/scene/tool_kinds.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/cpu/equilibrium.h"
#include "solver/gpu/gpu_solver.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

/// Returns a solver in the state that solver.start specifies.
std::unique_ptr<Solver> started(std::unique_ptr<TissueStepper> solver, const Model& model, const Scene& scene,
                                const std::shared_ptr<ThreadPool>& threads) {
  SettleReport report;
  if (scene.solver.start == SolverStart::kEquilibrium) solver->startFrom(equilibriumOf(model, scene, report, threads));
  return solver;
}

std::unique_ptr<TissueStepper> ticksOf(const Model& model, const Scene& scene, Backend backend,
                                       const std::shared_ptr<ThreadPool>& threads) {
  if (backend != Backend::kCpu) return std::make_unique<GpuSolver>(model, scene);
  CpuSolverOptions options;
  options.threads = threads;
  return std::make_unique<CpuSolver>(model, scene, options);
}

/// Returns a note for the user that only leapfrog stops a thin probe between nodes; empty if all probes are as wide as
/// cells.
std::string thinProbeNote(const Model& model, const Scene& scene) {
  if (scene.solver.integrator == Integrator::kLeapfrog) return "";
  double spacing_m = 0;
  for (const Body& body : model.bodies)
    spacing_m = std::max(spacing_m, body.network ? body.network->meanLength() : body.lattice.spacing_m);
  for (const StylusConfig& stylus : scene.styluses) {
    if (!mayPush(stylus) || stylus.probe.radius_m >= spacing_m) continue;
    return std::string(traitsOf(scene.solver.integrator).name) + "'s probes only touch nodes, and probe.radius_m of '" +
           stylus.name + "', " + numberText(stylus.probe.radius_m, 3) + " m, is less than a spacing, " +
           numberText(spacing_m, 3) + " m";
  }
  return "";
}

}  // namespace

Backend chooseBackend(const Scene& scene, const gpu::Context* context) {
  const SolverConfig& config = scene.solver;
  if (config.backend != Backend::kAuto) return config.backend;
  if (resistsBlades(scene) || tears(scene) || !scene.attachments.empty() || hasPressure(scene.bodies))
    return Backend::kCpu;
  return !context || context->isSoftware() ? Backend::kCpu : Backend::kGpu;
}

std::string backendNote(const Scene& scene, const gpu::Context* context, const Solver& solver,
                        const std::string& note) {
  const SolverConfig& config = scene.solver;
  const std::string taken = (note.empty() ? "" : "integrator: " + note + "; ") + solver.backend();
  if (config.backend != Backend::kAuto) return taken + ", as set by solver.backend";
  if (resistsBlades(scene))
    return taken + ", because tissue that resists blades (material.cut) would have to wait for a GPU in every substep";
  if (tears(scene)) return taken + ", because tearing (material.tear) only exists there";
  if (hasPressure(scene.bodies)) return taken + ", because pressure would have to wait for a GPU in every substep";
  if (!scene.attachments.empty()) return taken + ", because attachments would have to wait for a GPU in every substep";
  if (!context) return taken + ", because there is no OpenGL context";
  return taken +
         (context->isSoftware() ? ", because OpenGL is a software rasteriser: " : ", because OpenGL has a GPU: ") +
         context->renderer();
}

std::unique_ptr<Solver> makeSolver(const Model& model, const Scene& scene, const gpu::Context* context,
                                   const std::shared_ptr<ThreadPool>& threads, std::string* note) {
  const Backend backend = chooseBackend(scene, context);
  if (backend != Backend::kCpu && !context)
    throw GpuError("solver.backend: gpu needs an OpenGL context, but there is none; use cpu or auto");
  if (note) *note = thinProbeNote(model, scene);
  return started(ticksOf(model, scene, backend, threads), model, scene, threads);
}

}  // namespace viscera
