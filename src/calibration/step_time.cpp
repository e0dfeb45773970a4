// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/calibration/step_time.h"

#include <limits>
#include <memory>
#include <vector>

#include "calibration/timed_ticks.h"
#include "solver/make_solver.h"
#include "solver/tissue/substeps.h"
#include "viscera/gpu/context.h"
#include "viscera/model/scene/scene.h"
#include "viscera/solver/material.h"
#include "viscera/tools/tools.h"

namespace viscera {
namespace {

/// Nodes of the smaller lattice; the larger one has half its spacing. Below some 200,000 nodes a GPU's time is that of
/// a launch.
constexpr size_t kSmallOnCpu = 4000, kSmallOnGpu = 60000;
constexpr double kGrowth = 8;                                 ///< ratio of their nodes
constexpr int kExplicitSubsteps = 20, kImplicitSubsteps = 4;  ///< per tick: one round of measurements per so many
constexpr TimedTicks kTicks{5, 198, 0.15};  ///< per lattice; longer than a short disturbance of the machine
constexpr double kUndisturbed = 0.1;        ///< quantile of the ticks that counts: it is free of short disturbances
constexpr double kPatience_s = 1;           ///< a larger lattice that would take longer is not measured
constexpr double kTouch = 0.9;  ///< of a probe's radius from the tissue's topmost node: it touches and hardly dents

int substepsPerTick(const SolverConfig& solver) {
  return traitsOf(solver.integrator).is_explicit ? kExplicitSubsteps : kImplicitSubsteps;
}

/// Returns a scene with the same work per substep, in ticks with a fixed number of substeps, where tissue neither falls
/// nor sleeps.
Scene measuredScene(Scene scene, const Model& model) {
  SolverConfig& solver = scene.solver;
  solver.substeps = 0;
  solver.start = SolverStart::kRest;
  solver.max_substeps = std::numeric_limits<int>::max();
  fitTick(solver, model, substepsPerTick(solver));
  solver.sleep_speed_m_per_s = 0;
  scene.environment.gravity_m_per_s2.setZero();
  scene.attachments.clear();                                 // the model may lack one of their bodies
  for (BodyConfig& body : scene.bodies) body.pressure = {};  // and the surfaces of cavities
  return scene;
}

Vector3d topmost(const Lattice& lattice) {
  Vector3d top(0, 0, -std::numeric_limits<double>::infinity());
  for (const uint32_t slot : lattice.active_slots) {
    const Vector3d at = lattice.restPosition(slot);
    if (at.z() > top.z()) top = at;
  }
  return top;
}

/// Returns samples of all styluses at the top of the first body, with no button pressed.
StylusSamples touching(const Model& model, const Scene& scene) {
  StylusSamples samples;
  const Vector3d top = topmost(model.bodies.at(0).lattice);
  for (size_t s = 0; s < scene.styluses.size(); ++s) {
    samples[s].valid = true;
    samples[s].pose.position_m = top + kTouch * scene.styluses[s].probe.radius_m * Vector3d::UnitZ();
  }
  return samples;
}

TimedSubstep timeSubstep(const Model& model, const Scene& asked, const gpu::Context* context) {
  const Scene scene = measuredScene(asked, model);
  const std::unique_ptr<Solver> solver = makeSolver(model, scene, context);
  Tools tools(scene.styluses);
  const StylusSamples samples = touching(model, scene);
  const std::vector<double> seconds = substepTimes(
      *solver, [&] { return tools.advance(samples); }, kTicks);
  return {static_cast<double>(model.activeNodes()), percentile(seconds, kUndisturbed)};
}

}  // namespace

StepTime stepTimeThrough(const TimedSubstep& small, const TimedSubstep& large) {
  const double slope = (large.seconds - small.seconds) / (large.nodes - small.nodes);
  const double overhead = small.seconds - slope * small.nodes;
  if (large.nodes <= small.nodes || slope <= 0 || overhead < 0) return {0, large.seconds / large.nodes};
  return {overhead, slope};
}

StepTime measureStepTime(const UndividedBodies& bodies, const Scene& scene, const gpu::Context* context) {
  const bool on_gpu = chooseBackend(scene, context) == Backend::kGpu && context && !context->isSoftware();
  const double spacing_m = bodies.spacingOf(on_gpu ? kSmallOnGpu : kSmallOnCpu);
  const TimedSubstep small = timeSubstep(bodies.lattices(spacing_m), scene, context);
  const double expected_s = small.seconds * kGrowth * substepsPerTick(scene.solver) * (kWarmUpTicks + kTicks.least);
  if (expected_s > kPatience_s) return {0, small.seconds / small.nodes};
  return stepTimeThrough(small, timeSubstep(bodies.lattices(spacing_m / 2), scene, context));
}

}  // namespace viscera
