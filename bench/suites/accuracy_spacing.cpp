// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// How fine must an organ be? The heart under a probe's load, in cells of springs and by moments, by number of nodes and
// by time.
#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <cmath>

#include "bench/harness/experiment.h"
#include "bench/harness/rate.h"
#include "bench/suites/accuracy_parts.h"

namespace viscera::bench {

namespace {

constexpr double kProbeRadius_m = 0.012;  ///< of the ball about the place that is pressed
constexpr double kResidual = 1e-7;        ///< of conjugate gradients: the response is known to its square
// Issue 13.
constexpr double kShareOfError = 0.2;  ///< of the error of springs at as many nodes, at 4 mm
constexpr double kShareOfTime = 0.1;   ///< of the time of springs at an error of kWanted
constexpr double kWanted = 0.01;
constexpr double kJudged_m = 0.004;

Scene heartScene(double spacing_m, Cells cells) {
  BodyConfig heart;
  heart.source = TissueSource::kPhantom;
  heart.spacing_m = spacing_m;
  heart.skin = SkinSource::kVolume;
  heart.material.cells = cells;
  heart.material.drag_per_s = heart.material.dashpot_ratio = 0;
  FixedConfig top;
  top.shape = FixedShape::kPlane;
  top.point_m = Vector3d(0, 0, 0.03);
  top.normal = -Vector3d::UnitZ();
  heart.fixed.push_back(top);
  Scene scene;
  scene.bodies.push_back(heart);
  return scene;
}

/// Where the left side of the finest heart is pressed [m]; the same for all.
Vector3d sideOf(const Model& model) {
  const Lattice& lattice = model.bodies[0].lattice;
  Vector3d best = lattice.restPosition(lattice.active_slots[0]);
  for (uint32_t slot : lattice.active_slots) {
    const Vector3d at = lattice.restPosition(slot);
    if (at.x() > best.x() && at.z() < 0) best = at;
  }
  return best;
}

/// One newton against x, spread over the tissue in a ball, most at its middle; each node by its mass. [slots]
Field pressOn(const ReferenceSolver& solver, const Vector3d& side_m) {
  Field out(solver.slots(), Vector3d::Zero());
  double sum = 0;
  for (uint32_t slot : solver.active) {
    const double away = (solver.restPosition(slot) - side_m).norm() / kProbeRadius_m;
    if (away >= 1 || isFixed(solver.nodes[slot])) continue;
    const double weight = solver.mass(slot) * std::pow(1 - away * away, 2);
    out[slot].x() = -weight;
    sum += weight;
  }
  for (Vector3d& f : out) f /= sum;
  return out;
}

/// How far the load's middle goes [m per N], infinitesimal, float64: load times displacement.
double response(const Model& model, const Vector3d& side_m) {
  const ReferenceSolver solver(model, Vector3d::Zero(), 1);
  const Field load = pressOn(solver, side_m), rest(solver.slots(), Vector3d::Zero());
  const Eigen::SparseMatrix<double> whole = solver.stiffnessMatrix(rest);
  std::vector<int> place(static_cast<size_t>(solver.dofs()), -1);
  int free = 0;
  for (uint32_t slot : solver.active) {
    if (isFixed(solver.nodes[slot]) || solver.isIsolated(slot)) continue;
    for (int axis = 0; axis < 3; ++axis) place[static_cast<size_t>(solver.dof(slot, axis))] = free++;
  }
  std::vector<Eigen::Triplet<double>> kept;
  kept.reserve(static_cast<size_t>(whole.nonZeros()));
  for (int column = 0; column < whole.outerSize(); ++column) {
    if (place[static_cast<size_t>(column)] < 0) continue;
    for (Eigen::SparseMatrix<double>::InnerIterator it(whole, column); it; ++it) {
      const int row = place[static_cast<size_t>(it.row())];
      if (row >= 0) kept.emplace_back(row, place[static_cast<size_t>(column)], it.value());
    }
  }
  Eigen::SparseMatrix<double> k(free, free);
  k.setFromTriplets(kept.begin(), kept.end());
  Eigen::VectorXd f = Eigen::VectorXd::Zero(free);
  for (uint32_t slot : solver.active) {
    const int at = place[static_cast<size_t>(solver.dof(slot, 0))];
    if (at >= 0) f.segment<3>(at) = load[slot];
  }
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> gradients(k);
  gradients.setTolerance(kResidual);
  return f.dot(gradients.solve(f));
}

/// What was found at one spacing.
struct Found {
  double spacing_m, nodes, response, error = 0;
  std::vector<double> wall_s;  ///< [backends] per simulated second, leapfrog at half of dt_safe
};

Found measure(const Report& report, double spacing_m, Cells cells, const Vector3d& side_m) {
  const Model model = buildModel(heartScene(spacing_m, cells));
  Found out{spacing_m, static_cast<double>(model.activeNodes()), response(model, side_m), 0, {}};
  const Scene scene = plainScene(model, kSpecimenSubsteps);
  for (Backend backend : report.backends()) {
    std::shared_ptr<Ticks> solver = solverOn(backend, model, scene);
    const double dt_s = solver->dt_s();
    solver->writeState(wobbling(model, 0.02 * spacing_m, 0));
    const std::vector<Rate> rates =
        measureRates({candidate("", std::move(solver), model.activeNodes())}, report.isShort() ? 0.02 : 0.3, 3);
    out.wall_s.push_back(1 / (rates[0].substeps_per_s * dt_s));
  }
  return out;
}

/// log y = a + b log x, through all points: errors of stairs jump, their trend does not.
struct Trend {
  double a = 0, b = 0;
  Trend(const std::vector<double>& x, const std::vector<double>& y) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    const auto n = static_cast<double>(x.size());
    for (size_t i = 0; i < x.size(); ++i) {
      const double p = std::log(x[i]), q = std::log(std::max(y[i], 1e-12));
      sx += p, sy += q, sxx += p * p, sxy += p * q;
    }
    b = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    a = (sy - b * sx) / n;
  }
  double at(double x) const { return std::exp(a + b * std::log(x)); }
  double where(double y) const { return std::exp((std::log(y) - a) / b); }
};

std::vector<double> column(const std::vector<Found>& rows, double Found::*member) {
  std::vector<double> out;
  for (const Found& row : rows) out.push_back(row.*member);
  return out;
}

/// Errors at 4 mm at as many nodes, and times at 1 % of error, of cells by moments over those of springs.
void judge(Report& report, const std::vector<Found>& springs, const std::vector<Found>& moments) {
  const Trend by_nodes(column(springs, &Found::nodes), column(springs, &Found::error));
  for (const Found& row : moments) {
    if (row.spacing_m != kJudged_m) continue;
    report.checkAtMost("heart under a probe: error by moments at 4 mm over that of springs at as many nodes",
                       row.error / by_nodes.at(row.nodes), kShareOfError);
  }
  for (size_t b = 0; b < report.backends().size(); ++b) {
    const auto times = [&](const std::vector<Found>& rows) {
      std::vector<double> wall_s;
      for (const Found& row : rows) wall_s.push_back(row.wall_s[b]);
      return Trend(wall_s, column(rows, &Found::error)).where(kWanted);
    };
    report.checkAtMost(
        nameOf(report.backends()[b]) + ": heart under a probe: time by moments over springs at 1 % error",
        times(moments) / times(springs), kShareOfTime);
  }
}

}  // namespace

void measureSpacing(Report& report) {
  const std::vector<double> spacings =
      report.isShort() ? std::vector<double>{0.012, 0.01} : std::vector<double>{0.008, 0.006, 0.004, 0.003};
  const double finest_m = report.isShort() ? 0.008 : 0.002;
  report.stage("heart under a probe, finest");
  const Model finest = buildModel(heartScene(finest_m, Cells::kMoments));
  const Vector3d side_m = sideOf(finest);
  const double truth = response(finest, side_m);
  std::vector<Column> columns = {{"cells"}, {"spacing", "m"}, {"nodes", "", 6}, {"response", "m/N"}, {"error"}};
  for (Backend backend : report.backends()) columns.push_back({nameOf(backend) + ": wall s per simulated s", "", 3});
  Table table("Heart under a load of 1 N on its side: error against cells by moments at " +
                  Cell(finest_m * 1e3).text(2) + " mm, " + Cell(static_cast<double>(finest.activeNodes())).text(8) +
                  " nodes",
              columns);
  Plot by_nodes{"Heart under a probe", "nodes", "error of its response", true, true, {}};
  Plot by_wall{"Heart under a probe", "wall seconds per simulated second", "error of its response", true, true, {}};
  std::vector<Found> found[2];
  for (Cells cells : {Cells::kSprings, Cells::kMoments}) {
    const std::string name = cells == Cells::kSprings ? "springs" : "moments";
    std::vector<Found>& rows = found[cells == Cells::kMoments];
    for (double spacing_m : spacings) {
      report.stage("heart under a probe, " + name + ", " + Cell(spacing_m * 1e3).text(2) + " mm");
      rows.push_back(measure(report, spacing_m, cells, side_m));
      rows.back().error = std::abs(rows.back().response / truth - 1);
      std::vector<Cell> cellsOf = {name, spacing_m, rows.back().nodes, rows.back().response, rows.back().error};
      for (double wall_s : rows.back().wall_s) cellsOf.emplace_back(wall_s);
      table.add(cellsOf);
    }
    by_nodes.series.push_back({name, column(rows, &Found::nodes), column(rows, &Found::error)});
    for (size_t b = 0; b < report.backends().size(); ++b) {
      Series series{nameOf(report.backends()[b]) + ": " + name, {}, column(rows, &Found::error)};
      for (const Found& row : rows) series.x.push_back(row.wall_s[b]);
      by_wall.series.push_back(series);
    }
  }
  report.add(table, "spacing");
  report.add(by_nodes, "spacing_nodes");
  report.add(by_wall, "spacing_wall");
  if (!report.isShort()) judge(report, found[0], found[1]);
}

}  // namespace viscera::bench
