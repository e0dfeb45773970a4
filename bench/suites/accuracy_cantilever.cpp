// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/beam.h"
#include "bench/harness/work_precision.h"
#include "bench/suites/accuracy_parts.h"

namespace viscera::bench {

namespace {

constexpr int kTicks = 8;
constexpr int kTickInDtSafe = 32;
constexpr int kTruthSubsteps = 16 * kTickInDtSafe;  ///< per tick
constexpr int kMeasuredSubsteps = 24;    ///< per tick: 1.33 dt_safe, what solver.measured_limit takes at nu 1/4
constexpr double kDrag_per_s = 4;        ///< a scene's default
constexpr double kLeapfrogLimit = 1e-4;  ///< physics.md 2 found 1e-5 for smooth motion
const Vector3d kPull_m_per_s2(1, 0, 0);  ///< bends the beam by a tenth of its length
constexpr double kTruthError = 1e-6;     ///< what Richardson may still correct: below float32's error

std::vector<Method> methods(bool short_form) {
  std::vector<Method> out;
  for (Integrator integrator : {Integrator::kLeapfrog, Integrator::kVerletPaper}) {
    for (int substeps : short_form ? std::vector<int>{40, 64} : std::vector<int>{40, 64, 128, 256}) {
      out.push_back({integrator, substeps});
    }
  }
  for (Integrator integrator : {Integrator::kVbd, Integrator::kPd}) {
    for (int iterations : short_form ? std::vector<int>{5} : std::vector<int>{2, 5, 10, 20, 50}) {
      for (int substeps : short_form ? std::vector<int>{2, 8} : std::vector<int>{1, 2, 4, 8, 16, 32}) {
        out.push_back({integrator, substeps, iterations});
      }
    }
  }
  out.push_back({Integrator::kLeapfrog, kMeasuredSubsteps});
  return out;
}

}  // namespace

/// A beam bent by gravity across it, which ends at time 0.
void measureCantileverPrecision(Report& report) {
  report.stage("cantilever, truth in float64");
  MaterialConfig material;
  material.drag_per_s = kDrag_per_s;
  material.dashpot_ratio = 0;  // verlet_paper knows none
  Experiment experiment = experimentOf(beamModel({3, 3, 15}, material), kTickInDtSafe, kTicks);
  experiment.start = stateOf(experiment.model, sag(experiment.model, kPull_m_per_s2));
  const Track fine = runReference(experiment, kTruthSubsteps);
  const Track truth = extrapolated(runReference(experiment, kTruthSubsteps / 2), fine, 2);
  const double left = misfit(experiment.model, fine, truth).max;
  report.note("truth: float64 leapfrog at dt_safe/16 and /8, extrapolated; dt_safe/16 alone is off by " +
              Cell(left).text(3) + "; " + Cell(experiment.duration_s()).text(3) + " s simulated\n");
  const std::vector<Method> all = methods(report.isShort());
  const std::vector<std::vector<Misfit>> errors =
      drawWorkPrecision(report, experiment, truth, all, "cantilever", "Cantilever of 3x3x15 cells, bent and let go");
  report.checkAtMost("cantilever: what is left of dt in the truth", left, kTruthError);
  for (size_t b = 0; b < errors.size(); ++b) {
    report.checkAtMost(nameOf(report.backends()[b]) + ": cantilever: rms error of leapfrog at 0.8 dt_safe",
                       errors[b][0].rms, kLeapfrogLimit);
    report.checkAtMost(nameOf(report.backends()[b]) + ": cantilever: rms error of leapfrog at 1.33 dt_safe",
                       errors[b].back().rms, kLeapfrogLimit);
  }
}

}  // namespace viscera::bench
