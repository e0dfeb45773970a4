// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/experiment.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "tools/motion_packing.h"

namespace viscera::bench {

namespace {

constexpr double kNeverAsleep_m = 1e6;

Scene sceneFor(const Experiment& experiment, const Method& method) {
  Scene scene = experiment.scene;
  scene.solver.integrator = method.integrator;
  scene.solver.substeps = method.substeps;
  scene.solver.iterations = method.iterations;
  return scene;
}

Field fieldOf(const std::vector<layout::vec4>& values) {
  Field out;
  out.reserve(values.size());
  for (const layout::vec4& v : values) out.push_back(xyz(v));
  return out;
}

}  // namespace

std::string nameOf(Integrator integrator) {
  return traitsOf(integrator).name;
}

Experiment experimentOf(Model model, double tick_in_dt_safe, int ticks) {
  Experiment out;
  out.model = std::move(model);
  out.dt_safe_s = safeTimeStep(out.model);
  out.scene = plainScene(out.model, 1, tick_in_dt_safe);
  out.scene.solver.sleep_distance_m = kNeverAsleep_m;
  out.start = restState(out.model);
  out.motions.resize(static_cast<size_t>(ticks));
  return out;
}

Track runOn(Backend backend, const Experiment& experiment, const Method& method) {
  const std::unique_ptr<TissueStepper> solver = solverOn(backend, experiment.model, sceneFor(experiment, method), true);
  solver->step(experiment.motions[0]);  // drivers finish compiling at the first use
  solver->readState();
  solver->reset();
  solver->writeState(experiment.start);
  Track track;
  for (const ToolMotions& motions : experiment.motions) {
    const auto start = std::chrono::steady_clock::now();
    solver->step(motions);
    const HostState state = solver->readState();
    track.wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    track.u_m.push_back(fieldOf(state.displacement_m));
  }
  return track;
}

Track runReference(const Experiment& experiment, int substeps, ReferenceIntegrator integrator) {
  ReferenceOptions options;
  options.integrator = integrator;
  options.push_speed_m_per_s = pushSpeed(experiment.model);
  ReferenceSolver solver(experiment.model, experiment.scene.environment.gravity_m_per_s2,
                         1 / (experiment.scene.solver.tick_hz * substeps), options);
  solver.u_m = fieldOf(experiment.start.displacement_m);
  solver.v_m_per_s = fieldOf(experiment.start.velocity_m_per_s);
  Track track;
  const ToolActs acts(experiment.scene.styluses, 1 / experiment.scene.solver.tick_hz);
  std::vector<layout::ToolMotion> tools;
  for (const ToolMotions& motions : experiment.motions) {
    solver.markTick();
    acts.beginTick(solver, motions);
    interpolateMotions(motions, experiment.scene.styluses, substeps, tools);
    for (size_t s = 0; s < static_cast<size_t>(substeps); ++s) {
      solver.substep({tools[s * layout::kMaxStyluses], tools[s * layout::kMaxStyluses + 1]});
    }
    acts.endTick(solver, motions);
    track.u_m.push_back(solver.u_m);
  }
  return track;
}

Track extrapolated(const Track& coarse, const Track& fine, int order) {
  const double factor = 1 / (std::exp2(order) - 1);
  Track out = fine;
  for (size_t t = 0; t < out.u_m.size(); ++t) {
    for (size_t i = 0; i < out.u_m[t].size(); ++i) out.u_m[t][i] += factor * (fine.u_m[t][i] - coarse.u_m[t][i]);
  }
  return out;
}

Misfit misfit(const Model& model, const Track& track, const Track& truth) {
  double sum2 = 0, largest = 0, size = 0;
  size_t count = 0;
  for (size_t t = 0; t < truth.u_m.size(); ++t) {
    for (size_t b = 0; b < model.bodies.size(); ++b) {
      for (uint32_t local : model.bodies[b].lattice.active_slots) {
        const uint32_t slot = model.slotOffset(b) + local;
        const double error = (track.u_m[t][slot] - truth.u_m[t][slot]).norm();
        sum2 += error * error;
        largest = worse(largest, error);
        size = std::max(size, truth.u_m[t][slot].norm());
        ++count;
      }
    }
  }
  return {std::sqrt(sum2 / static_cast<double>(count)) / size, largest / size};
}

double worse(double a, double b) {
  return std::isnan(a) || a >= b ? a : b;
}

double slope(double coarse_error, double fine_error) {
  return std::log2(coarse_error / fine_error);
}

}  // namespace viscera::bench
