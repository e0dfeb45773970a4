// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "bench/harness/specimens/beam.h"
#include "bench/harness/work_precision.h"
#include "bench/suites/accuracy/accuracy_parts.h"

namespace viscera::bench {

namespace {

Model cantilever(const MaterialConfig& material) {
  return beamModel({3, 3, 15}, material);
}
/// Returns a shell of one to two cells.
Model dome(const MaterialConfig& material) {
  return domeModel(6, 1.6, kBeamSpacing_m, material);
}

/// A body, its material and its ticks.
struct Tissue {
  Model (*make)(const MaterialConfig&);
  double poisson_ratio;
  int tick_in_dt_safe;
  Vector3d pull_m_per_s2;
  double truth_error;  ///< accepted residual of Richardson extrapolation: well below the errors that are compared
  const char *stem, *title;
};
// m/s2: deflects the beam by a tenth of its length, the dome by a twentieth of its radius.
const Vector3d kAcross(1, 0, 0), kAside(25, 0, 0);
constexpr double kBeamTruth = 1e-6, kDomeTruth = 1e-4;  // below float32's error; a tenth of leapfrog's
// For stiff, nearly incompressible tissue a tick of 1/60 s has about a hundred substeps.
const Tissue kTissues[] = {
    {cantilever, 0.25, 32, kAcross, kBeamTruth, "cantilever", "Cantilever of 3x3x15 cells, bent and released"},
    {cantilever, 0.49, 128, kAcross, kBeamTruth, "cantilever_049", "Cantilever at nu 0.49, ticks of 128 dt_safe"},
    {dome, 0.25, 32, kAside, kDomeTruth, "shell",
     "Dome of 6 cells' radius, wall 1 to 2 cells, pulled sideways and released"},
    {dome, 0.49, 128, kAside, kDomeTruth, "shell_049", "The same dome at nu 0.49, ticks of 128 dt_safe"}};
constexpr int kTicks = 8;
constexpr int kTruthSubsteps = 16;       ///< number per dt_safe
constexpr double kMeasured = 4.0 / 3;    ///< [dt_safe] substep of solver.measured_limit at nu 1/4
constexpr double kDrag_per_s = 4;        ///< default of scenes
constexpr double kLeapfrogLimit = 1e-4;  ///< physics.md 2 found 1e-5 for smooth motion

/// Returns the number of substeps per tick for a length in dt_safe.
int substepsOf(const Tissue& tissue, double in_dt_safe) {
  return static_cast<int>(std::lround(tissue.tick_in_dt_safe / in_dt_safe));
}

/// Returns the methods; the last is leapfrog's longest substep.
/// @param leapfrog_alone  cells of a law support no other integrator
std::vector<Method> methods(const Tissue& tissue, bool leapfrog_alone, bool short_form) {
  std::vector<Method> out;
  for (Integrator integrator : {Integrator::kLeapfrog, Integrator::kVerletPaper}) {
    if (leapfrog_alone && integrator != Integrator::kLeapfrog) continue;
    for (double dt : short_form ? std::vector<double>{0.8, 0.5} : std::vector<double>{0.8, 0.5, 0.25, 0.125}) {
      out.push_back({integrator, substepsOf(tissue, dt)});
    }
  }
  for (int iterations : short_form ? std::vector<int>{5} : std::vector<int>{2, 5, 10, 20, 50}) {
    for (int substeps : short_form ? std::vector<int>{2, 8} : std::vector<int>{1, 2, 4, 8, 16, 32}) {
      if (!leapfrog_alone) out.push_back({Integrator::kPd, substeps, iterations});
    }
  }
  out.push_back({Integrator::kLeapfrog, substepsOf(tissue, kMeasured)});
  return out;
}

/// Measures a body that gravity has bent and that is released at time 0.
void measure(Report& report, const Tissue& tissue) {
  const std::string stem = tissue.stem;
  report.stage(stem + ", truth in float64");
  MaterialConfig material = withPoisson({}, tissue.poisson_ratio);
  material.mass_damping_per_s = kDrag_per_s;
  material.stiffness_damping_ratio = 0;  // verlet_paper does not support dashpots
  Experiment experiment = experimentOf(tissue.make(material), tissue.tick_in_dt_safe, kTicks);
  experiment.start = stateOf(experiment.model, sag(experiment.model, tissue.pull_m_per_s2));
  const int substeps = kTruthSubsteps * tissue.tick_in_dt_safe;
  const Track fine = runReference(experiment, substeps);
  const Track truth = extrapolated(runReference(experiment, substeps / 2), fine, 2);
  const double left = misfit(experiment.model, fine, truth).max;
  report.note("truth: float64 leapfrog at dt_safe/16 and /8, extrapolated; dt_safe/16 alone differs by " +
              Cell(left).text(3) + "; " + Cell(experiment.duration_s()).text(3) + " s simulated\n");
  const std::vector<Method> tried = methods(tissue, material.law == Law::kNeoHookean, report.isShort());
  const std::vector<std::vector<Misfit>> errors =
      drawWorkPrecision(report, experiment, truth, tried, stem, tissue.title);
  report.checkAtMost(stem + ": remaining error of dt in the truth", left, tissue.truth_error);
  if (tissue.make != cantilever) return;  // a dome has waves that substeps near dt_safe do not resolve as well
  for (size_t b = 0; b < errors.size(); ++b) {
    const std::string name = nameOf(report.backends()[b]) + ": " + stem + ": rms error of leapfrog at ";
    report.checkAtMost(name + "0.8 dt_safe", errors[b][0].rms, kLeapfrogLimit);
    report.checkAtMost(name + "1.33 dt_safe", errors[b].back().rms, kLeapfrogLimit);
  }
}

}  // namespace

void measureCantileverPrecision(Report& report) {
  for (const Tissue& tissue : kTissues) measure(report, tissue);
}

}  // namespace viscera::bench
