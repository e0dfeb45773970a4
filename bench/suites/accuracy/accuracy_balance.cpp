// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Conservation by the lattice: momentum and energy.
#include <algorithm>
#include <cmath>
#include <random>

#include "bench/harness/experiment.h"
#include "bench/harness/specimens/beam.h"
#include "bench/suites/accuracy/accuracy_parts.h"

namespace viscera::bench {

namespace {

constexpr double kMomentumLimit = 1e-6, kDriftLimit = 1e-4;  ///< issue 3
constexpr double kDrift_dt = 0.5;                            ///< [dt_safe]

Field randomField(const Model& model, double size_m, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size_m, size_m);
  Field out(model.slots(), Vector3d::Zero());
  for (uint32_t slot : model.bodies[0].lattice.active_slots) {
    for (int axis = 0; axis < 3; ++axis) out[slot][axis] = static_cast<float>(uniform(random));
  }
  return out;
}

/// Returns |sum F| / sum |F|.
double unbalance(const Field& force_n) {
  Vector3d sum = Vector3d::Zero();
  double sizes = 0;
  for (const Vector3d& f : force_n) {
    sum += f;
    sizes += f.norm();
  }
  return sum.norm() / sizes;
}

/// Returns the total energy from velocities of half a substep before [J]: kinetic 1/2 m v- . v+, which for springs
/// without geometric nonlinearity is conserved exactly (physics.md 6, oracle 8).
double energyOf(ReferenceSolver& solver, const HostState& state, double dt_s) {
  for (uint32_t slot : solver.active) solver.u_m[slot] = xyz(state.displacement_m[slot]);
  double kinetic = 0;
  for (uint32_t slot : solver.active) {
    if (isFixed(solver.nodes[slot])) continue;
    const Vector3d before = xyz(state.velocity_m_per_s[slot]);
    const Vector3d after = before + dt_s / solver.mass(slot) * solver.elasticForce(solver.u_m, slot);
    kinetic += 0.5 * solver.mass(slot) * before.dot(after);
  }
  return kinetic + solver.elasticEnergy(solver.u_m);
}

double mean(const std::vector<double>& values, size_t first, size_t last) {
  double sum = 0;
  for (size_t i = first; i < last; ++i) sum += values[i];
  return sum / static_cast<double>(last - first);
}

/// Returns the energy at the end of each tick [J].
std::vector<double> energies(const Experiment& experiment, Backend backend) {
  const std::unique_ptr<TissueStepper> solver = solverOn(backend, experiment.model, experiment.scene);
  solver->writeState(experiment.start);
  ReferenceSolver reference(experiment.model, Vector3d::Zero(), 1);
  std::vector<double> out;
  for (size_t t = 0; t < experiment.motions.size(); ++t) {
    solver->step({});
    out.push_back(energyOf(reference, solver->readState(), solver->dt_s()));
  }
  return out;
}

}  // namespace

void measureMomentum(Report& report) {
  report.stage("momentum");
  Table table("Sum of the forces on a free block of 6x5x4 cells, random displacements",
              {{"backend"}, {"nu"}, {"displacement", "h"}, {"|sum F|/sum|F|", "", 3}});
  for (Backend backend : report.backends()) {
    double worst = 0;
    for (double nu : {0.25, 0.45}) {
      for (double size : {1e-3, 0.1, 1.0}) {
        MaterialConfig material = withPoisson({}, nu);
        material.mass_damping_per_s = material.stiffness_damping_ratio = 0;
        const Model model = blockModel({6, 5, 4}, kBeamSpacing_m, material);
        const double found = unbalance(forcesOn(backend, model, randomField(model, size * kBeamSpacing_m, 1)));
        table.add({nameOf(backend), nu, size, found});
        worst = worse(worst, found);
      }
    }
    report.checkAtMost(nameOf(backend) + ": largest |sum F| / sum |F|", worst, kMomentumLimit);
  }
  report.add(table, "momentum");
}

void measureEnergyDrift(Report& report) {
  const int ticks = report.isShort() ? 20 : 1000, substeps = 1000;
  MaterialConfig material;
  material.mass_damping_per_s = material.stiffness_damping_ratio = 0;
  Experiment experiment = experimentOf(beamModel({2, 2, 3}, material), kDrift_dt * substeps, ticks);
  experiment.start = stateOf(experiment.model, bent(experiment.model, 0.1 * kBeamSpacing_m));
  experiment.scene.solver.substeps = substeps;
  Table table("Energy of a clamped block of 2x2x3 cells, leapfrog without drag and dashpot, dt_safe/2",
              {{"backend"}, {"substeps"}, {"drift"}, {"drift per substep"}, {"largest - smallest"}});
  Plot plot{"Energy of an undamped block", "substeps / 1000", "energy / start - 1", false, false, {}};
  for (Backend backend : report.backends()) {
    report.stage("energy over " + std::to_string(ticks * substeps) + " substeps, " + nameOf(backend));
    const std::vector<double> energy = energies(experiment, backend);
    Series series{nameOf(backend), {}, {}, Series::Style::kLines};
    for (size_t t = 0; t < energy.size(); ++t) {
      series.x.push_back(static_cast<double>(t + 1));  // in thousands of substeps
      series.y.push_back(energy[t] / energy.front() - 1);
    }
    plot.series.push_back(series);
    const size_t part = energy.size() / 10;
    const double first = mean(energy, 0, part), last = mean(energy, energy.size() - part, energy.size());
    const double drift = last / first - 1;
    const auto [low, high] = std::minmax_element(energy.begin(), energy.end());
    table.add({nameOf(backend), ticks * substeps, drift, drift / (0.9 * ticks * substeps), (*high - *low) / first});
    report.checkAtMost(nameOf(backend) + ": energy drift over " + Cell(ticks * substeps).text(7) + " substeps",
                       std::abs(drift), kDriftLimit);
  }
  report.add(table, "energy");
  report.add(plot, "energy");
}

}  // namespace viscera::bench
