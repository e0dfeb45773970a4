// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/stability/stability_suite.h"

#include <algorithm>
#include <map>

#include "bench/suites/stability/stability_trial.h"
#include "viscera/solver/material.h"

namespace viscera::bench {

namespace {

constexpr int kTicks = 60;
constexpr double kStabilityEnergyBound = 1.01;  // relative to the start's energy

/// Returns a block of springs.
Model blockOf(int cells) {
  return blockModel(Vector3i::Constant(cells), kStabilitySpacing_m, {});
}

/// The worst of the cells of one check.
struct Worst {
  int not_finite = 0;
  double energy_ratio = 0, energy_left = 0, over_bound = 0;

  void add(const Outcome& outcome) {
    not_finite += outcome.finite ? 0 : 1;
    energy_ratio = std::max(energy_ratio, outcome.energy_ratio);
    over_bound = worse(over_bound, outcome.over_bound);
    if (outcome.had_energy) energy_left = worse(energy_left, outcome.energy_left);
  }
};

Table startsTable(const std::string& title) {
  return Table(title, {{"backend"},
                       {"start"},
                       {"integrator"},
                       {"dt over limit"},
                       {"finite"},
                       {"max energy over start", "", 5},
                       {"over stability monitor's bound"},
                       {"energy left"},
                       {"recovered"},
                       {"stability monitor trips"},
                       {"frames to recover"},
                       {"ticks"}});
}

void addRow(Table& table, Backend backend, const Start& start, Integrator integrator, double ratio, const Outcome& o) {
  table.add({nameOf(backend), start.name, nameOf(integrator), ratio, o.finite ? "yes" : "NO", o.energy_ratio,
             o.over_bound, o.energy_left, o.frames_to_recover >= 0 ? "yes" : "bounded", static_cast<double>(o.trips),
             o.frames_to_recover >= 0 ? Cell(o.frames_to_recover) : Cell(""), o.ticks});
}

/// Returns energy over time.
Series curve(const Outcome& outcome, Integrator integrator, double ratio) {
  Series out{nameOf(integrator) + ", dt " + Cell(ratio).text(3) + " x limit", {}, {}, Series::Style::kLines};
  for (size_t t = 0; t < outcome.energies.size(); ++t) {
    out.x.push_back(static_cast<double>(t + 1));
    out.y.push_back(outcome.energies[t]);
  }
  return out;
}

/// Tests all starts with all integrators that the body supports, on one backend.
class Trials {
 public:
  Trials(Report& report, Model model, const std::string& title)
      : report_(report), model_(std::move(model)), starts_(extremeStarts(model_)), table_(startsTable(title)) {
    if (report.isShort()) starts_ = {starts_[0], starts_[1], starts_[5], starts_[6]};
  }

  void run(Backend backend, const std::vector<double>& ratios, const std::string& stem) {
    Plot plot{"energy after the start '" + starts_[0].name + "', stability monitor on, " + nameOf(backend),
              "ticks",
              "energy over start",
              true,
              true,
              {}};
    Worst stable, above;
    for (const IntegratorTraits& traits : kIntegrators) {
      if (hasLaw(model_) && traits.integrator != Integrator::kLeapfrog) continue;
      report_.stage("starts, " + nameOf(traits.integrator) + ", " + nameOf(backend));
      for (double ratio : ratios) {
        // dt_safe is a bound for springs; cells of a law need shorter substeps the more they are strained.
        const bool promised = !traits.own_positions && (!traits.is_explicit || (ratio <= 1 && !hasLaw(model_)));
        plot.series.push_back(
            curve(runStarts(backend, traits.integrator, ratio, promised ? stable : above), traits.integrator, ratio));
      }
    }
    report_.add(plot, stem + "_" + nameOf(backend));
    const std::string name = nameOf(backend) + ": " + stem;
    report_.checkAtMost(name + ": cells with a value that is not finite", stable.not_finite + above.not_finite, 0);
    report_.checkAtMost(name + ": energy over start, leapfrog within its limit, implicit ones", stable.energy_ratio,
                        kStabilityEnergyBound);
    report_.checkAtMost(name + ": energy left at the end over start, explicit above the limit, a law and verlet_paper",
                        above.energy_left, kStabilityEnergyBound);
    report_.checkAtMost(name + ": energy over what the stability monitor lets pass",
                        worse(stable.over_bound, above.over_bound), 1);
  }
  const Table& table() const { return table_; }

 private:
  /// Runs all starts. @return the outcome of the first start
  Outcome runStarts(Backend backend, Integrator integrator, double ratio, Worst& worst) {
    const Scene scene = sceneAt(model_, integrator, ratio);
    Outcome first;
    for (const Start& start : starts_) {
      const Outcome outcome = tryStart(backend, model_, scene, start, report_.isShort() ? 20 : kTicks);
      worst.add(outcome);
      addRow(table_, backend, start, integrator, ratio, outcome);
      if (&start == &starts_[0]) first = outcome;
    }
    return first;
  }

  Report& report_;
  Model model_;
  std::vector<Start> starts_;
  Table table_;
};

void tryAll(Report& report, Model model, const std::string& what, const std::vector<double>& ratios,
            const std::string& stem) {
  Trials trials(report, std::move(model), "extreme starts, " + what);
  for (Backend backend : report.backends()) trials.run(backend, ratios, stem);
  report.add(trials.table(), stem);
}

}  // namespace

void startsOfStability(Report& report) {
  using Ratios = std::vector<double>;
  const int cells = report.isShort() ? 4 : 6;
  const std::string nu = "Poisson's ratio ";
  tryAll(report, blockOf(cells), "springs", report.isShort() ? Ratios{1, 10} : Ratios{0.1, 1, 10, 100}, "starts");
  tryAll(report, askewBox(cells, 0.25), "neo_hookean, " + nu + "0.25",
         report.isShort() ? Ratios{1} : Ratios{0.1, 1, 10, 100}, "starts_law");
  if (!report.isShort())
    tryAll(report, askewBox(cells, 0.45), "neo_hookean, " + nu + "0.45", {1, 10}, "starts_law_045");
}

void fractionsOfStability(Report& report) {
  const Model model = blockOf(report.isShort() ? 4 : 6);
  std::vector<Start> starts = extremeStarts(model);
  if (report.isShort()) starts.resize(2);
  Table table("leapfrog without stability monitor: largest energy over the start's, by substep over dt_safe",
              {{"backend"},
               {"start"},
               {"0.5", "", 5},
               {"0.6", "", 5},
               {"0.7", "", 5},
               {"0.75", "", 5},
               {"0.8", "", 5},
               {"0.9 (no dashpot)", "", 5}});
  Model undamped = model;
  undamped.bodies[0].material.stiffness_damping_ratio = 0;
  for (Backend backend : report.backends()) {
    report.stage("fractions of dt_safe, " + nameOf(backend));
    for (const Start& start : starts) {
      std::vector<Cell> row = {nameOf(backend), start.name};
      for (double fraction : {0.5, 0.6, 0.7, 0.75, 0.8, 0.9}) {
        const Model& tried = fraction > 0.82 ? undamped : model;
        const double xi = tried.bodies[0].material.stiffness_damping_ratio;
        Scene scene =
            sceneAt(tried, Integrator::kLeapfrog, fraction / (0.999 * stableFraction(Integrator::kLeapfrog, xi)));
        scene.solver.stability_monitor = false;
        const Outcome outcome = tryStart(backend, tried, scene, start, report.isShort() ? 20 : kTicks);
        row.push_back(outcome.finite ? Cell(outcome.energy_ratio) : Cell("not finite"));
      }
      table.add(row);
    }
  }
  report.add(table, "fractions");
}

void measuredOfStability(Report& report) {
  Table table("leapfrog as it is by default, substeps measured, stability monitor on", {{"backend"},
                                                                                        {"law"},
                                                                                        {"nu"},
                                                                                        {"start"},
                                                                                        {"dt at rest", "dt_safe", 3},
                                                                                        {"limit", "dt_safe", 3},
                                                                                        {"largest energy", "start", 3},
                                                                                        {"energy left", "start", 3},
                                                                                        {"stability monitor trips"}});
  for (Backend backend : report.backends()) {
    Worst worst;
    double left = 0;  // without the start in which forces have no direction
    for (const double nu : report.isShort() ? std::vector<double>{0.25} : std::vector<double>{0.25, 0.45, 0.49}) {
      report.stage("measured substeps, nu " + Cell(nu).text(3) + ", " + nameOf(backend));
      const int cells = report.isShort() ? 4 : 6;
      std::vector<Model> models = {askewBox(cells, nu)};
      if (nu == 0.25) models.push_back(blockOf(cells));
      for (const Model& model : models) {
        Scene scene = sceneAt(model, Integrator::kLeapfrog, 1);
        scene.solver.tick_hz = SolverConfig{}.tick_hz;
        scene.solver.substeps = 0;
        const std::unique_ptr<TissueStepper> solver = solverOn(backend, model, scene, false);
        const double dt = solver->dt_s() / solver->dtSafe_s(), limit = solver->dtLimit_s() / solver->dtSafe_s();
        for (const Start& start : extremeStarts(model)) {
          const Outcome outcome = tryStart(backend, model, scene, start, report.isShort() ? 20 : kTicks);
          worst.add(outcome);
          if (start.name != kCollapsed) left = worse(left, outcome.energy_left);
          table.add({nameOf(backend), nameOf(model.bodies[0].material.law), nu, start.name, dt, limit,
                     outcome.finite ? Cell(outcome.energy_ratio) : Cell("not finite"), outcome.energy_left,
                     static_cast<double>(outcome.trips)});
        }
      }
    }
    report.checkAtMost(nameOf(backend) + ": measured: cells with a value that is not finite", worst.not_finite, 0);
    report.checkAtMost(nameOf(backend) + ": measured: energy over start", worst.energy_ratio, kStabilityEnergyBound);
    report.checkAtMost(nameOf(backend) + ": measured: energy left at the end over start, but of the collapsed one",
                       left, kStillFolded);
  }
  report.add(table, "measured");
}

void stabilitySuite(Report& report) {
  measureParts(report, {{"starts", startsOfStability},
                        {"fractions", fractionsOfStability},
                        {"measured", measuredOfStability},
                        {"strain", strainOfStability},
                        {"tools", toolsOfStability},
                        {"wounds", woundsOfStability},
                        {"places", positionsOfStability},
                        {"extremes", extremesOfStability}});
}

}  // namespace viscera::bench
