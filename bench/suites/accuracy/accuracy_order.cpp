// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>

#include "bench/harness/experiment.h"
#include "bench/harness/specimens/beam.h"
#include "bench/suites/accuracy/accuracy_parts.h"

namespace viscera::bench {

namespace {

constexpr double kTolerance = 0.1;  ///< issue 3: tolerance of a slope
constexpr int kAccuracyOrderTicks = 4;
constexpr double kTickInDtSafe = 32;
constexpr int kAccuracyOrderTruthSubsteps = 1024;  ///< number per tick
constexpr double kBend_m = 5e-4;                   ///< deflection of the tip [m]: a thirtieth of the length
constexpr double kAccuracyOrderDrag_per_s = 20;
constexpr double kDashpot = 0.2;

/// Damping that the reference must include.
struct Damping {
  double mass_damping_per_s = 0, stiffness_damping_ratio = 0;
};

/// Integrator, damping and iterations of one row, and the expected order.
struct Row {
  std::string name;
  Method longest;
  Damping damping;
  int halvings;
  double order;                  ///< order that must be reached; 0: shown only
  bool whole_first_kick = true;  ///< verlet_paper: as printed; otherwise from the velocity half a substep before
};

Experiment swing(const Damping& damping) {
  MaterialConfig material;
  material.mass_damping_per_s = damping.mass_damping_per_s;
  material.stiffness_damping_ratio = damping.stiffness_damping_ratio;
  Experiment out = experimentOf(beamModel({2, 2, 4}, material), kTickInDtSafe, kAccuracyOrderTicks);
  out.start = stateOf(out.model, bent(out.model, kBend_m));
  return out;
}

/// Extrapolates to dt -> 0. A dashpot uses the velocity of half a substep before, so its error is of first order.
Track truthOf(const Experiment& experiment, const Damping& damping) {
  const int order = damping.stiffness_damping_ratio > 0 ? 1 : 2;
  return extrapolated(runReference(experiment, kAccuracyOrderTruthSubsteps / 2),
                      runReference(experiment, kAccuracyOrderTruthSubsteps), order);
}

/// Sets the velocity half a substep before the start, for which position Verlet's first full kick is of second order.
void stagger(Experiment& experiment, int substeps) {
  ReferenceSolver solver(experiment.model, Vector3d::Zero(), 1);
  for (uint32_t slot : solver.active) solver.u_m[slot] = xyz(experiment.start.displacement_m[slot]);
  const double half_s = 0.5 / (experiment.scene.solver.tick_hz * substeps);
  for (uint32_t slot : solver.active) {
    if (isFixed(solver.nodes[slot])) continue;
    const Vector3d force = solver.elasticForce(solver.u_m, slot);
    experiment.start.velocity_m_per_s[slot] = vec4(-half_s / solver.mass(slot) * force);
  }
}

/// Returns errors for the longest substep and its repeated halves.
std::vector<double> errorsOf(Backend backend, const Row& row, const Experiment& experiment, const Track& truth) {
  std::vector<double> errors;
  for (int i = 0; i <= row.halvings; ++i) {
    Method method = row.longest;
    method.substeps <<= i;
    Experiment run = experiment;
    if (!row.whole_first_kick) stagger(run, method.substeps);
    errors.push_back(misfit(run.model, runOn(backend, run, method), truth).rms);
  }
  return errors;
}

std::vector<Row> rowsOf(bool short_form) {
  const Method leapfrog{Integrator::kLeapfrog, 40}, verlet{Integrator::kVerletPaper, 40};
  const Method pd{Integrator::kPd, 40, 30};
  const Damping none, drag{kAccuracyOrderDrag_per_s, 0}, dashpot{0, kDashpot};
  if (short_form) {
    return {{"leapfrog", leapfrog, none, 1, 2}, {"pd", pd, none, 1, 1}};
  }
  return {
      {"leapfrog", leapfrog, none, 3, 2},
      {"leapfrog, drag", leapfrog, drag, 3, 2},
      {"leapfrog, dashpot", leapfrog, dashpot, 3, 0},
      {"verlet_paper", verlet, none, 3, 0},
      {"verlet_paper, half kick", verlet, none, 3, 0, false},
      {"verlet_paper, half kick, drag", verlet, drag, 3, 0, false},
      {"pd", pd, none, 3, 1},
      {"pd, drag", pd, drag, 2, 1},
  };
}

constexpr size_t kColors = 8;  ///< of gnuplot; further rows would coincide with earlier curves

class OrderTable {
 public:
  explicit OrderTable(Report& report) : report_(report) {}
  void add(Backend backend, const Row& row, const std::vector<double>& errors);
  void finish();

 private:
  Report& report_;
  Table table_{"Order: a beam swings in its lowest mode; rms error against dt -> 0 over max displacement",
               {{"backend"}, {"integrator"}, {"dt", "dt_safe"}, {"rms error", "", 3}, {"slope"}}};
  std::map<Backend, Plot> plots_;
};

void OrderTable::add(Backend backend, const Row& row, const std::vector<double>& errors) {
  Series series{row.name, {}, {}};
  double off = 0;
  for (size_t i = 0; i < errors.size(); ++i) {
    const double dt = kTickInDtSafe / (row.longest.substeps << i);
    const double found = i > 0 ? slope(errors[i - 1], errors[i]) : 0;
    table_.add({nameOf(backend), row.name, dt, errors[i], i > 0 ? Cell(found) : Cell("")});
    series.x.push_back(dt);
    series.y.push_back(errors[i]);
    if (i > 0) off = worse(off, std::abs(found - row.order));
  }
  std::vector<Series>& curves = plots_[backend].series;
  if (curves.size() < kColors) curves.push_back(series);
  if (row.order > 0) {
    report_.checkAtMost(
        nameOf(backend) + ": order of " + row.name + ": largest |slope - " + Cell(row.order).text(2) + "|", off,
        kTolerance);
  }
}

void OrderTable::finish() {
  report_.add(table_, "order");
  for (const auto& [backend, plot] : plots_) {
    report_.add(Plot{"Error against substep: a beam in its lowest mode, " + nameOf(backend), "dt / dt_safe",
                     "rms error / max displacement", true, true, plot.series},
                "order_" + nameOf(backend));
  }
}

}  // namespace

void measureOrder(Report& report) {
  OrderTable out(report);
  std::map<std::pair<double, double>, std::pair<Experiment, Track>> known;
  for (const Row& row : rowsOf(report.isShort())) {
    report.stage("order, " + row.name);
    const auto key = std::make_pair(row.damping.mass_damping_per_s, row.damping.stiffness_damping_ratio);
    if (known.count(key) == 0) {
      const Experiment experiment = swing(row.damping);
      known[key] = {experiment, truthOf(experiment, row.damping)};
    }
    for (Backend backend : report.backends()) {
      out.add(backend, row, errorsOf(backend, row, known[key].first, known[key].second));
    }
  }
  out.finish();
}

}  // namespace viscera::bench
