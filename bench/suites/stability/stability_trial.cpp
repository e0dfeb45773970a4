// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/stability/stability_trial.h"

#include <algorithm>
#include <cmath>

namespace viscera::bench {

namespace {

constexpr double kTick_s = 1.0 / 60;
constexpr double kRecovered = 0.01;  // relative to the start's energy
constexpr double kNoEnergy = 1e-6;   // relative to M c_p^2: rounding of a mirrored lattice, which has no energy
constexpr int kFewest = 12;          // [ticks]
constexpr double kSweeps = 25000;    // passes over all nodes that a trial may take: a few seconds

double sweepsPerTick(const Scene& scene) {
  const IntegratorTraits& traits = traitsOf(scene.solver.integrator);
  const int iterations = traits.iterates ? scene.solver.iterations : 1;
  return scene.solver.substeps * iterations;
}

bool isFinite(const Model& model, const HostState& state) {
  for (uint32_t slot : model.bodies[0].lattice.active_slots) {
    if (!xyz(state.displacement_m[slot]).allFinite() || !xyz(state.velocity_m_per_s[slot]).allFinite()) return false;
  }
  return true;
}

}  // namespace

Model askewBox(int cells, double poisson_ratio) {
  BodyConfig body;
  body.name = "box";
  body.source = TissueSource::kBox;
  body.box_size_m = Vector3d::Constant(kStabilitySpacing_m * (cells - 1));
  body.rotation_deg = Vector3d(20, 35, 10);
  body.spacing_m = kStabilitySpacing_m;
  body.material.law = Law::kNeoHookean;
  body.material.poisson_ratio = poisson_ratio;
  Scene scene;
  scene.bodies.push_back(body);
  return buildModel(scene);
}

Scene sceneAt(const Model& model, Integrator integrator, double ratio) {
  Scene scene;
  scene.environment.gravity_m_per_s2 = Vector3d::Zero();
  scene.solver.integrator = integrator;
  scene.solver.sleep_distance_m = 100;  // the boundary of the world stops nothing
  const double limit = stableFraction(integrator, model.bodies[0].material.stiffness_damping_ratio);
  const double dt_s = ratio * safeTimeStep(model) * (traitsOf(integrator).is_explicit ? 0.999 * limit : 1);
  scene.solver.substeps = std::max(1, static_cast<int>(std::ceil(kTick_s / dt_s)));
  scene.solver.tick_hz = 1 / (scene.solver.substeps * dt_s);
  return scene;
}

Outcome tryStart(Backend backend, const Model& model, const Scene& scene, const Start& start, int ticks) {
  const std::unique_ptr<TissueStepper> made = solverOn(backend, model, scene, true);
  TissueStepper& solver = *made;
  ReferenceSolver reference(model, Vector3d::Zero(), solver.dt_s());
  solver.writeState(start.state);
  const double whole_j = stabilityLimits(model, 0, 0).energy_j;
  const double at_start_j = energyOf(reference, start.state, 0);
  const double first_j = std::max(at_start_j, kNoEnergy * whole_j);
  Outcome out;
  out.had_energy = at_start_j >= kNoEnergy * whole_j;
  out.ticks = std::clamp(static_cast<int>(kSweeps / sweepsPerTick(scene)), std::min(kFewest, ticks), ticks);
  for (int t = 1; t <= out.ticks; ++t) {
    solver.step({});
    const HostState state = solver.readState();
    out.finite = out.finite && isFinite(model, state);
    if (!out.finite) break;
    // Beyond the limit half a kick is not small, and velocities at one moment are meaningless: they are used unchanged.
    const double lag_s = solver.dt_s() <= solver.dtLimit_s() ? solver.velocityLag_s() : 0;
    const double energy_j = energyOf(reference, state, lag_s);
    out.energy_left = energy_j / first_j;
    out.over_bound = std::max(out.over_bound, energy_j / (2 * (first_j + whole_j)));
    out.energies.push_back(out.energy_left);
    out.energy_ratio = std::max(out.energy_ratio, out.energy_left);
    if (out.frames_to_recover < 0 && out.energy_left < kRecovered) out.frames_to_recover = t;
  }
  out.trips = solver.health().trips;
  return out;
}

}  // namespace viscera::bench
