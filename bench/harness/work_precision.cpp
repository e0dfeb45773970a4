// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/work_precision.h"

namespace viscera::bench {

namespace {

/// Returns whether a curve is drawn, since gnuplot has eight colours. The table has all.
bool isDrawn(const Method& method) {
  return !method.iterates() || method.iterations == 2 || method.iterations == 10 || method.iterations == 50;
}

std::string seriesOf(const Method& method) {
  return nameOf(method.integrator) +
         (method.iterates() ? ", " + std::to_string(method.iterations) + " iterations" : "");
}

void addPoint(Plot& plot, const std::string& name, double x, double y) {
  if (plot.series.empty() || plot.series.back().name != name) plot.series.push_back({name, {}, {}});
  plot.series.back().x.push_back(x);
  plot.series.back().y.push_back(y);
}

Table tableOf(const std::string& title, const std::vector<Backend>& backends) {
  std::vector<Column> columns = {{"integrator"}, {"dt", "dt_safe"}, {"iterations"}, {"sweeps per simulated s"}};
  for (Backend backend : backends) {
    columns.push_back({nameOf(backend) + ": wall s per simulated s", "", 3});
    columns.push_back({nameOf(backend) + ": rms error", "", 3});
    columns.push_back({nameOf(backend) + ": max error", "", 3});
  }
  return Table(title + "; error against dt -> 0 over max displacement", columns);
}

}  // namespace

std::vector<std::vector<Misfit>> drawWorkPrecision(Report& report, const Experiment& experiment, const Track& truth,
                                                   const std::vector<Method>& methods, const std::string& stem,
                                                   const std::string& title) {
  const std::vector<Backend>& backends = report.backends();
  Table table = tableOf(title, backends);
  Plot by_wall{title, "wall seconds per simulated second", "rms error / max displacement", true, true, {}};
  std::vector<Plot> by_sweeps(backends.size(),
                              {title, "sweeps per simulated second", "rms error / max displacement", true, true, {}});
  std::vector<Plot> walls(backends.size());
  std::vector<std::vector<Misfit>> errors(backends.size());
  for (const Method& method : methods) {
    const double dt = 1 / (experiment.scene.solver.tick_hz * method.substeps * experiment.dt_safe_s);
    const double sweeps = method.sweeps() * experiment.scene.solver.tick_hz;
    std::vector<Cell> row = {nameOf(method.integrator), dt, method.iterates() ? Cell(method.iterations) : Cell(""),
                             sweeps};
    report.stage(stem + ", " + seriesOf(method) + ", dt " + Cell(dt).text(3) + " dt_safe");
    for (size_t b = 0; b < backends.size(); ++b) {
      const Track track = runOn(backends[b], experiment, method);
      const Misfit error = misfit(experiment.model, track, truth);
      const double wall = track.wall_s / experiment.duration_s();
      for (double value : {wall, error.rms, error.max}) row.emplace_back(value);
      errors[b].push_back(error);
      if (isDrawn(method) || report.isShort()) addPoint(by_sweeps[b], seriesOf(method), sweeps, error.rms);
      if (method.iterates() && method.iterations != 10 && !report.isShort()) continue;
      addPoint(walls[b], nameOf(backends[b]) + ": " + seriesOf(method), wall, error.rms);
    }
    table.add(row);
  }
  report.add(table, stem);
  for (size_t b = 0; b < backends.size(); ++b) {
    report.add(by_sweeps[b], stem + "_sweeps_" + nameOf(backends[b]));
    by_wall.series.insert(by_wall.series.end(), walls[b].series.begin(), walls[b].series.end());
  }
  report.add(by_wall, stem + "_wall");
  return errors;
}

}  // namespace viscera::bench
