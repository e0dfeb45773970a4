// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "bench/harness/specimens/block.h"
#include "bench/harness/specimens/mode_frequency.h"
#include "bench/suites/material/material_parts.h"

namespace viscera::bench {

namespace {

constexpr int kMasses = 16;
constexpr int kSamples = 100;
constexpr double kAmplitude = 1e-3;  ///< relative to the spacing; along its axis a chain is linear at any amplitude
constexpr double kPhaseStep = 1.2;   ///< largest phase between samples: small phases are lost in float32's rounding
constexpr double kMaterialChainsLimit = 1e-4;  ///< issue 3: relative

enum class End { kFixed, kFree };

/// Returns unit masses along z with unit springs, the lower end fixed; a free end has half a mass.
Model chain(End end) {
  const int count = end == End::kFixed ? kMasses + 2 : kMasses + 1;
  Model model = blockModel({1, 1, count - 1}, 1, unitMaterial());
  Lattice& lattice = model.bodies[0].lattice;
  lattice.active_slots.clear();
  for (uint32_t slot = 0; slot < lattice.nodes.size(); ++slot) {
    const Vector3i n = lattice.nodeAt(slot);
    layout::NodeBits& bits = lattice.nodes[slot];
    const bool keep = n.x() == 0 && n.y() == 0 && massEighths(bits) > 0, last = n.z() == count - 1;
    bits = {};
    if (!keep) continue;
    bits.lo = (last && end == End::kFree ? 4u : 8u) << layout::kMassShift;
    if (n.z() == 0 || (last && end == End::kFixed)) bits.lo |= layout::kFixedBit;
    lattice.active_slots.push_back(slot);
    if (!last) setSpringCount(bits, 4, 4);
    if (n.z() > 0) setSpringCount(bits, 5, 4);
  }
  return model;
}

/// Returns the wave number of mode p times the spacing.
double waveNumber(End end, int p) {
  return end == End::kFixed ? p * M_PI / (kMasses + 1) : (2 * p - 1) * M_PI / (2 * kMasses);
}

double measuredFrequency(Backend backend, const Model& model, double q, double omega) {
  const double dt_s = plainScene(model, 1).solver.dt_fraction * safeTimeStep(model);
  const int stride = std::max(1, static_cast<int>(kPhaseStep / phasePerSubstep(omega, dt_s)));
  const std::unique_ptr<TissueStepper> solver = solverOn(backend, model, plainScene(model, stride));
  const Lattice& lattice = model.bodies[0].lattice;
  Field shape(model.slots(), Vector3d::Zero());
  for (uint32_t slot : lattice.active_slots) shape[slot].z() = kAmplitude * std::sin(q * lattice.nodeAt(slot).z());
  solver->writeState(stateOf(model, shape));
  std::vector<double> amplitude;
  for (int n = 0; n < kSamples; ++n) {
    const HostState state = solver->readState();
    double sum = 0;
    // Modes are orthogonal under the masses.
    for (uint32_t slot : lattice.active_slots) {
      if (isFixed(lattice.nodes[slot])) continue;
      sum += massEighths(lattice.nodes[slot]) * shape[slot].dot(xyz(state.displacement_m[slot]));
    }
    amplitude.push_back(sum);
    solver->step({});
  }
  return modeFrequency(amplitude, stride, solver->dt_s());
}

}  // namespace

void measureChains(Report& report) {
  Table table("Chains of " + std::to_string(kMasses) + " masses, k = m = 1; leapfrog's time error taken out",
              {{"backend"}, {"ends"}, {"mode"}, {"formula", "rad/s", 7}, {"measured", "rad/s", 7}, {"relative error"}});
  Plot plot{"Frequencies of chains", "mode", "abs(relative error)", false, true, {}};
  for (Backend backend : report.backends()) {
    double worst = 0;
    for (End end : {End::kFixed, End::kFree}) {
      const std::string name = end == End::kFixed ? "fixed-fixed" : "fixed-free";
      report.stage("chains, " + name + ", " + nameOf(backend));
      const Model model = chain(end);
      Series series{nameOf(backend) + ", " + name, {}, {}};
      for (int p : {1, 2, 4, 8, 12, kMasses}) {
        const double q = waveNumber(end, p), exact = 2 * std::sin(q / 2);
        const double omega = measuredFrequency(backend, model, q, exact), error = omega / exact - 1;
        table.add({nameOf(backend), name, p, exact, omega, error});
        series.x.push_back(p);
        series.y.push_back(std::abs(error));
        worst = std::max(worst, std::abs(error));
      }
      plot.series.push_back(series);
    }
    report.checkAtMost(nameOf(backend) + ": chains: largest relative error of a frequency", worst,
                       kMaterialChainsLimit);
  }
  report.add(table, "chains");
  report.add(plot, "chains");
}

}  // namespace viscera::bench
