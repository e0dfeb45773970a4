// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "bench/harness/experiment.h"
#include "bench/harness/specimens/beam.h"
#include "bench/suites/accuracy/accuracy_parts.h"
#include "model/scene/integrators.h"
#include "viscera/math/state_hash.h"

namespace viscera::bench {

namespace {

constexpr double kLimit = 1e-6;  ///< issue 3: relative to the largest displacement
constexpr int kSubstepsPerTick = 100;
constexpr double kTip_m = 2e-3;           ///< initial deflection of the tip [m]
constexpr double kGravity_m_per_s2 = 1;   ///< across the beam
constexpr double kSpacing_m = 1.0 / 256;  ///< float32 represents every rest position at origin 0 exactly

/// A configuration.
struct Case {
  double mass_damping_per_s = 0;
  double origin_m = 0;  ///< offset of the beam along x; twice and three times this along y and z
  double dt_in_dt_safe = 0.5;
  bool compensated = false;  ///< whether Kahan's sums of u and v are used
};

/// Returns a bent beam that is released under gravity across it.
Experiment letGo(const Case& c, int substeps) {
  MaterialConfig material;
  material.mass_damping_per_s = c.mass_damping_per_s;
  material.stiffness_damping_ratio = 0;
  Model model = blockModel({2, 2, 8}, kSpacing_m, material, [](const Vector3i& node) { return node.z() == 0; });
  const Field start = bent(model, kTip_m);
  model.bodies[0].lattice.origin_m = c.origin_m * Vector3d(1, 2, 3);
  Experiment out = experimentOf(std::move(model), kSubstepsPerTick * c.dt_in_dt_safe, substeps / kSubstepsPerTick);
  out.scene.environment.gravity_m_per_s2.x() = kGravity_m_per_s2;
  out.scene.solver.compensated = c.compensated;
  out.start = stateOf(out.model, start);
  return out;
}

/// Runs float64 with the substep of the kernels, which is rounded to float32.
Track sameSubstep(const Experiment& experiment, ReferenceIntegrator integrator) {
  Experiment rounded = experiment;
  const double dt_s = 1 / (experiment.scene.solver.tick_hz * kSubstepsPerTick);
  rounded.scene.solver.tick_hz = 1 / (kSubstepsPerTick * static_cast<double>(static_cast<float>(dt_s)));
  return runReference(rounded, kSubstepsPerTick, integrator);
}

/// Returns the hash of the displacements at the ends of all ticks.
uint64_t hashOf(const Track& track) {
  StateHash hash;
  for (const Field& u_m : track.u_m) {
    for (const Vector3d& u : u_m) {
      for (int axis = 0; axis < 3; ++axis) hash.add(static_cast<float>(u[axis]));
    }
  }
  return hash.value();
}

/// A variant, compared with its own reference at the same substep.
struct Variant {
  Integrator integrator;
  bool compensated;
  const char* state;
};
constexpr Variant kVariants[] = {{Integrator::kLeapfrog, false, "displacement"},
                                 {Integrator::kLeapfrog, true, "displacement, compensated"},
                                 {Integrator::kVerletPaper, false, "position"}};

/// Compares displacements (leapfrog) with positions (verlet_paper), near and far from the origin.
class Variables {
 public:
  Variables(Report& report, int substeps)
      : report_(report),
        substeps_(substeps),
        worst_(report.backends().size()),
        same_(report.backends().size(), true),
        table_("float32 against float64 with the same substep, after " + std::to_string(substeps) +
                   " substeps of dt_safe/2; errors over max displacement",
               {{"backend"},
                {"integrator"},
                {"state"},
                {"drag", "1/s"},
                {"origin", "m"},
                {"rms error", "", 3},
                {"max error", "", 3},
                {"fingerprint"}}) {}

  /// Runs all variants with one drag and checks the guaranteed limits.
  void run(double drag) {
    std::fill(worst_.begin(), worst_.end(), 0);
    for (const Variant& variant : kVariants) {
      report_.stage("float32, " + nameOf(variant.integrator) + ", drag " + Cell(drag).text(2) + " per s");
      const Track truth = sameSubstep(letGo({drag}, substeps_), traitsOf(variant.integrator).truth);
      for (size_t b = 0; b < worst_.size(); ++b) runVariant(variant, drag, truth, b);
    }
    for (size_t b = 0; b < worst_.size(); ++b) {
      report_.checkAtMost(nameOf(report_.backends()[b]) + ": float32 against float64, leapfrog, drag " +
                              Cell(drag).text(2) + " per s" + (drag == 0 ? ", compensated" : "") +
                              ": largest error over max displacement",
                          worst_[b], kLimit);
    }
  }
  void finish() {
    report_.add(table_, "float32");
    for (size_t b = 0; b < same_.size(); ++b) {
      report_.checkAtLeast(
          nameOf(report_.backends()[b]) + ": the same bits with the object at 0, 1 and 1000 m (1: yes)", same_[b], 1);
    }
  }

 private:
  void runVariant(const Variant& variant, double drag, const Track& truth, size_t b) {
    uint64_t first = 0;
    for (double origin : {0.0, 1.0, 1000.0}) {
      const Experiment experiment = letGo({drag, origin, 0.5, variant.compensated}, substeps_);
      const Track track = runOn(report_.backends()[b], experiment, {variant.integrator, kSubstepsPerTick});
      const Misfit error = misfit(experiment.model, track, truth);
      const uint64_t hash = hashOf(track);
      if (origin == 0) first = hash;
      table_.add({nameOf(report_.backends()[b]), nameOf(variant.integrator), variant.state, drag, origin, error.rms,
                  error.max, StateHash::text(hash)});
      if (traitsOf(variant.integrator).own_positions) continue;  // has no guaranteed limit
      if (variant.compensated == (drag == 0)) worst_[b] = worse(worst_[b], error.max);
      same_[b] = same_[b] && hash == first;
    }
  }

  Report& report_;
  int substeps_;
  std::vector<double> worst_;  ///< [backends] for this drag
  std::vector<bool> same_;     ///< [backends] whether hashes are equal
  Table table_;
};

/// Measures the gain of Kahan's sums for short substeps.
void compareSums(Report& report, int substeps) {
  Table table(
      "Compensated sums of u and v (leapfrog) against plain ones, after " + std::to_string(substeps) + " substeps",
      {{"backend"},
       {"dt", "dt_safe"},
       {"max error, plain", "", 3},
       {"max error, compensated", "", 3},
       {"plain/compensated", "", 3}});
  for (Backend backend : report.backends()) {
    for (double dt : {0.5, 0.125, 1.0 / 32}) {
      report.stage("compensated sums, dt " + Cell(dt).text(3) + " dt_safe, " + nameOf(backend));
      double error[2];
      for (int i = 0; i < 2; ++i) {
        const Experiment experiment = letGo({0, 0, dt, i == 1}, substeps);
        const Track track = runOn(backend, experiment, {Integrator::kLeapfrog, kSubstepsPerTick});
        error[i] = misfit(experiment.model, track, sameSubstep(experiment, ReferenceIntegrator::kLeapfrog)).max;
      }
      table.add({nameOf(backend), dt, error[0], error[1], error[0] / error[1]});
    }
  }
  report.add(table, "compensation");
}

}  // namespace

void measureFloat32(Report& report) {
  const int substeps = report.isShort() ? 1000 : 10000;
  Variables variables(report, substeps);
  for (double drag : {4.0, 0.0}) variables.run(drag);
  variables.finish();
  if (!report.isShort()) compareSums(report, substeps);
}

}  // namespace viscera::bench
