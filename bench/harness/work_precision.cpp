// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/work_precision.h"

namespace viscera::bench {

namespace {

/// Curves that are drawn: gnuplot has eight colours. The table has all.
bool isDrawn(const Method& method) {
  return !method.isImplicit() || method.iterations == 2 || method.iterations == 10 || method.iterations == 50;
}

std::string seriesOf(const Method& method) {
  return nameOf(method.integrator) +
         (method.isImplicit() ? ", " + std::to_string(method.iterations) + " iterations" : "");
}

void addPoint(Plot& plot, const std::string& name, double x, double y) {
  if (plot.series.empty() || plot.series.back().name != name) plot.series.push_back({name, {}, {}});
  plot.series.back().x.push_back(x);
  plot.series.back().y.push_back(y);
}

}  // namespace

std::vector<Misfit> drawWorkPrecision(Report& report, const Experiment& experiment, const Track& truth,
                                      const std::vector<Method>& methods, const std::string& stem,
                                      const std::string& title) {
  Table table(title + "; error against dt -> 0 over max displacement", {{"integrator"},
                                                                        {"dt", "dt_safe"},
                                                                        {"iterations"},
                                                                        {"sweeps per simulated s"},
                                                                        {"wall s per simulated s", "", 3},
                                                                        {"rms error", "", 3},
                                                                        {"max error", "", 3}});
  Plot by_sweeps{title, "sweeps per simulated second", "rms error / max displacement", true, true, {}};
  Plot by_wall{title, "wall seconds per simulated second", "rms error / max displacement", true, true, {}};
  std::vector<Misfit> errors;
  for (const Method& method : methods) {
    const double dt = 1 / (experiment.scene.solver.tick_hz * method.substeps * experiment.dt_safe_s);
    report.stage(stem + ", " + seriesOf(method) + ", dt " + Cell(dt).text(3) + " dt_safe");
    const Track track = runGpu(experiment, method);
    const Misfit error = misfit(experiment.model, track, truth);
    const double sweeps = method.sweeps() * experiment.scene.solver.tick_hz;
    const double wall = track.wall_s / experiment.duration_s();
    table.add({nameOf(method.integrator), dt, method.isImplicit() ? Cell(method.iterations) : Cell(""), sweeps, wall,
               error.rms, error.max});
    errors.push_back(error);
    if (!isDrawn(method) && !report.isShort()) continue;
    addPoint(by_sweeps, seriesOf(method), sweeps, error.rms);
    addPoint(by_wall, seriesOf(method), wall, error.rms);
  }
  report.add(table, stem);
  report.add(by_sweeps, stem + "_sweeps");
  report.add(by_wall, stem + "_wall");
  return errors;
}

}  // namespace viscera::bench
