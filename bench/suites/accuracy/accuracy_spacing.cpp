// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Measures how fine an organ must be: a heart with thin walls and a solid ball under a probe's load, with springs and
// the neo-Hookean law, by number of nodes and by time.
#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <cmath>

#include "bench/harness/experiment.h"
#include "bench/harness/rate.h"
#include "bench/harness/specimens/clamp.h"
#include "bench/suites/accuracy/accuracy_parts.h"

namespace viscera::bench {

namespace {

constexpr double kAccuracySpacingProbeRadius_m = 0.012;  ///< radius of the ball in which the load is distributed [m]
constexpr double kResidual = 1e-7;  ///< tolerance of conjugate gradients: the response is accurate to its square
// Issue 13.
constexpr double kShareOfError = 0.2;  ///< relative to the error of springs with the same number of nodes, at 4 mm
constexpr double kShareOfTime = 0.1;   ///< relative to the time of springs at an error of kWanted
constexpr double kWanted = 0.01;
constexpr double kJudged_m = 0.004;
constexpr double kFinest_m = 0.0016;  ///< spacing of the reference; tellStep() reports its accuracy

/// A body that is fixed at its top and pressed at several positions on its side.
struct Organ {
  std::string name;
  BodyConfig body;
  double held_z_m;
};

Organ heart() {
  BodyConfig body;
  body.source = TissueSource::kPhantom;
  return {"heart", body, 0.03};
}

Organ ball() {
  BodyConfig body;
  body.source = TissueSource::kBall;
  body.ball_radius_m = 0.03;
  return {"ball", body, 0.02};
}

Scene sceneOf(const Organ& organ, double spacing_m, Law law) {
  BodyConfig body = organ.body;
  body.spacing_m = spacing_m;
  body.skin = SkinSource::kVolume;
  body.material.law = law;
  body.material.mass_damping_per_s = body.material.stiffness_damping_ratio = 0;
  body.fixed.push_back(clampAbove(organ.held_z_m));
  Scene scene;
  scene.bodies.push_back(body);
  return scene;
}

/// Position and direction of a press.
struct Press {
  Vector3d position_m, direction;
};

/// Returns the farthest positions below the clamp in several directions, pressed inwards.
std::vector<Press> pressesOn(const Model& model) {
  const Lattice& lattice = model.bodies[0].lattice;
  std::vector<Press> out;
  for (const Vector3d& direction : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0),
                                    Vector3d(0, 0, -1), Vector3d(0.6, 0.6, -0.5)}) {
    Press press{lattice.restPosition(lattice.active_slots[0]), -direction.normalized()};
    for (uint32_t slot : lattice.active_slots) {
      const Vector3d at = lattice.restPosition(slot);
      if (at.dot(direction) > press.position_m.dot(direction) && at.z() < 0) press.position_m = at;
    }
    out.push_back(press);
  }
  return out;
}

/// Returns a load of one newton, distributed over a ball with the maximum at its centre, and weighted by nodal mass.
/// [slots]
Field pressOn(const ReferenceSolver& solver, const Press& press) {
  Field out(solver.slots(), Vector3d::Zero());
  double sum = 0;
  for (uint32_t slot : solver.active) {
    const double away = (solver.restPosition(slot) - press.position_m).norm() / kAccuracySpacingProbeRadius_m;
    if (away >= 1 || isFixed(solver.nodes[slot])) continue;
    const double weight = solver.mass(slot) * std::pow(1 - away * away, 2);
    out[slot] = weight * press.direction;
    sum += weight;
  }
  for (Vector3d& f : out) f /= sum;
  return out;
}

/// Returns the index of each free component by degree of freedom; -1 for the others.
std::vector<int> freePositions(const ReferenceSolver& solver, int& free) {
  std::vector<int> position(static_cast<size_t>(solver.dofs()), -1);
  free = 0;
  for (uint32_t slot : solver.active) {
    if (isFixed(solver.nodes[slot]) || solver.isIsolated(slot)) continue;
    for (int axis = 0; axis < 3; ++axis) position[static_cast<size_t>(solver.dof(slot, axis))] = free++;
  }
  return position;
}

Eigen::SparseMatrix<double> freeStiffness(const ReferenceSolver& solver, const std::vector<int>& position, int free) {
  const Field rest(solver.slots(), Vector3d::Zero());
  const Eigen::SparseMatrix<double> whole = solver.stiffnessMatrix(rest);
  std::vector<Eigen::Triplet<double>> kept;
  kept.reserve(static_cast<size_t>(whole.nonZeros()));
  for (int column = 0; column < whole.outerSize(); ++column) {
    if (position[static_cast<size_t>(column)] < 0) continue;
    for (Eigen::SparseMatrix<double>::InnerIterator it(whole, column); it; ++it) {
      const int row = position[static_cast<size_t>(it.row())];
      if (row >= 0) kept.emplace_back(row, position[static_cast<size_t>(column)], it.value());
    }
  }
  Eigen::SparseMatrix<double> k(free, free);
  k.setFromTriplets(kept.begin(), kept.end());
  return k;
}

/// Returns the displacement at each load per force [m/N], infinitesimal, float64: load times displacement. It is
/// arbitrary, even negative, if the tissue has a hinge.
std::vector<double> responses(const Model& model, const std::vector<Press>& presses) {
  const ReferenceSolver solver(model, Vector3d::Zero(), 1);
  int free = 0;
  const std::vector<int> position = freePositions(solver, free);
  const Eigen::SparseMatrix<double> k = freeStiffness(solver, position, free);
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> gradients(k);
  gradients.setTolerance(kResidual);
  std::vector<double> out;
  for (const Press& press : presses) {
    const Field load = pressOn(solver, press);
    Eigen::VectorXd f = Eigen::VectorXd::Zero(free);
    for (uint32_t slot : solver.active) {
      const int at = position[static_cast<size_t>(solver.dof(slot, 0))];
      if (at >= 0) f.segment<3>(at) = load[slot];
    }
    out.push_back(f.dot(gradients.solve(f)));
  }
  return out;
}

/// Errors at one spacing and at the factors of kPlaced, which place the lattice differently on the organ.
struct Found {
  double spacing_m = 0, nodes = 0, middle = 0, largest = 0;  ///< median and largest error of all placements
  std::vector<double> wall_s;  ///< [backends] wall time per simulated second, leapfrog at half of dt_safe
};
const std::vector<double> kPlaced = {0.97, 1, 1.03};

/// Returns the error of a response as a logarithm, so that twice and half are alike. At most 1, which represents any
/// factor beyond 2.7, such as that of tissue with a hinge.
double errorOf(double response, double truth) {
  return response > 0 ? std::min(std::abs(std::log(response / truth)), 1.0) : 1.0;
}

Found measure(const Report& report, const Organ& organ, double spacing_m, Law law, const std::vector<Press>& presses,
              const std::vector<double>& truth) {
  Found out;
  std::vector<double> errors;
  for (double placed : report.isShort() ? std::vector<double>{1} : kPlaced) {
    const Model model = buildModel(sceneOf(organ, placed * spacing_m, law));
    const std::vector<double> found = responses(model, presses);
    for (size_t i = 0; i < found.size(); ++i) errors.push_back(errorOf(found[i], truth[i]));
  }
  std::sort(errors.begin(), errors.end());
  out.spacing_m = spacing_m;
  out.middle = 0.5 * (errors[errors.size() / 2] + errors[(errors.size() - 1) / 2]);
  out.largest = errors.back();
  const Model model = buildModel(sceneOf(organ, spacing_m, law));
  out.nodes = static_cast<double>(model.activeNodes());
  const Scene scene = plainScene(model, kSpecimenSubsteps);
  for (Backend backend : report.backends()) {
    std::shared_ptr<TissueStepper> solver = solverOn(backend, model, scene);
    const double dt_s = solver->dt_s();
    solver->writeState(wobbling(model, 0.02 * spacing_m, 0));
    const std::vector<Rate> rates =
        measureRates({candidate("", std::move(solver), model.activeNodes())}, report.isShort() ? 0.02 : 0.3, 3);
    out.wall_s.push_back(1 / (rates[0].substeps_per_s * dt_s));
  }
  return out;
}

/// Fit of log y = a + b log x through all points: errors due to stairs jump, but their trend does not.
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

/// Checks the ratios of the law to springs: errors at 4 mm with the same number of nodes, and times at 1 % error.
void judge(Report& report, const Organ& organ, const std::vector<Found>& springs, const std::vector<Found>& law) {
  for (const auto& [name, member] : {std::pair("middle", &Found::middle), std::pair("largest", &Found::largest)}) {
    const Trend by_nodes(column(springs, &Found::nodes), column(springs, member));
    for (const Found& row : law) {
      if (row.spacing_m != kJudged_m) continue;
      report.checkAtMost(
          organ.name + " under a probe: " + name + " error of the law at 4 mm over that of springs at as many nodes",
          row.*member / by_nodes.at(row.nodes), kShareOfError);
    }
  }
  for (size_t b = 0; b < report.backends().size(); ++b) {
    const auto times = [&](const std::vector<Found>& rows) {
      std::vector<double> wall_s;
      for (const Found& row : rows) wall_s.push_back(row.wall_s[b]);
      return Trend(wall_s, column(rows, &Found::middle)).where(kWanted);
    };
    report.checkAtMost(
        nameOf(report.backends()[b]) + ": " + organ.name + " under a probe: time of the law over springs at 1 % error",
        times(law) / times(springs), kShareOfTime);
  }
}

/// Curves of both laws.
struct Curves {
  Plot by_nodes, by_wall;
  explicit Curves(const Organ& organ)
      : by_nodes{organ.name + " under a probe", "nodes", "error of its response", true, true, {}},
        by_wall{organ.name + " under a probe",
                "wall seconds per simulated second",
                "error of its response",
                true,
                true,
                {}} {}

  void add(const Report& report, const std::string& name, const std::vector<Found>& rows) {
    by_nodes.series.push_back({name, column(rows, &Found::nodes), column(rows, &Found::middle)});
    by_nodes.series.push_back({name + ", largest", column(rows, &Found::nodes), column(rows, &Found::largest)});
    for (size_t b = 0; b < report.backends().size(); ++b) {
      Series series{nameOf(report.backends()[b]) + ": " + name, {}, column(rows, &Found::middle)};
      for (const Found& row : rows) series.x.push_back(row.wall_s[b]);
      by_wall.series.push_back(series);
    }
  }
};

/// Reports how far the reference still changes with the spacing.
void tellStep(Report& report, const Organ& organ, const std::vector<Press>& presses, const std::vector<double>& truth) {
  constexpr double kCoarser = 1.25;
  const std::vector<double> before =
      responses(buildModel(sceneOf(organ, kCoarser * kFinest_m, Law::kNeoHookean)), presses);
  double largest = 0;
  for (size_t i = 0; i < truth.size(); ++i) largest = std::max(largest, errorOf(before[i], truth[i]));
  report.note(organ.name + ": from " + Cell(kCoarser * kFinest_m * 1e3).text(2) + " to " +
              Cell(kFinest_m * 1e3).text(2) + " mm its responses change by up to " + Cell(largest).text(2) + "\n");
}

void measureOrgan(Report& report, const Organ& organ) {
  const std::vector<double> spacings =
      report.isShort() ? std::vector<double>{0.012, 0.01} : std::vector<double>{0.008, 0.006, 0.004, 0.003};
  const double finest_m = report.isShort() ? 0.008 : kFinest_m;
  const std::string what = organ.name + " under a probe";
  report.stage(what + ", finest");
  const Model finest = buildModel(sceneOf(organ, finest_m, Law::kNeoHookean));
  const std::vector<Press> presses = pressesOn(finest);
  const std::vector<double> truth = responses(finest, presses);
  if (!report.isShort()) tellStep(report, organ, presses, truth);
  std::vector<Column> columns = {{"law"}, {"spacing", "m"}, {"nodes", "", 6}, {"middle error"}, {"largest error"}};
  for (Backend backend : report.backends()) columns.push_back({nameOf(backend) + ": wall s per simulated s", "", 3});
  Table table(what + ", a load of 1 N at six places: error against cells of the law at " +
                  Cell(finest_m * 1e3).text(2) + " mm, " + Cell(static_cast<double>(finest.activeNodes())).text(8) +
                  " nodes",
              columns);
  Curves curves(organ);
  std::vector<Found> found[2];
  for (Law law : {Law::kSprings, Law::kNeoHookean}) {
    const std::string name = nameOf(law);
    std::vector<Found>& rows = found[law == Law::kNeoHookean];
    for (double spacing_m : spacings) {
      report.stage(what + ", " + name + ", " + Cell(spacing_m * 1e3).text(2) + " mm");
      rows.push_back(measure(report, organ, spacing_m, law, presses, truth));
      std::vector<Cell> cells = {name, spacing_m, rows.back().nodes, rows.back().middle, rows.back().largest};
      for (double wall_s : rows.back().wall_s) cells.emplace_back(wall_s);
      table.add(cells);
    }
    curves.add(report, name, rows);
  }
  report.add(table, "spacing_" + organ.name);
  report.add(curves.by_nodes, "spacing_nodes_" + organ.name);
  report.add(curves.by_wall, "spacing_wall_" + organ.name);
  if (!report.isShort()) judge(report, organ, found[0], found[1]);
}

}  // namespace

void measureSpacing(Report& report) {
  for (const Organ& organ : {heart(), ball()}) measureOrgan(report, organ);
}

}  // namespace viscera::bench
