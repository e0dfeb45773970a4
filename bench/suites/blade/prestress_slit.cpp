// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/blade/prestress_slit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "solver/cpu/cpu_solver.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"

namespace viscera::bench {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kSides = 16;           // sides of the rim: a circle to within 1 %
constexpr double kDrag_per_s = 150;  // about twice the sheet's lowest frequency
constexpr double kSettle_s = 0.3;    // oscillations decay by e^-20
constexpr double kOpening = 0.05;    // relative to the law
constexpr double kUncut = 1e-3;      // relative to the opening: nothing moves before the cut
constexpr double kReasonable = 12;   // spacings in half a slit
constexpr double kYoungModulus_pa = 20e3;

Scene sceneOf(const SlitTrial& trial) {
  Scene scene;
  BodyConfig body;
  const double radius_m = trial.radius * trial.half_m;
  const double side_m = 2 * trial.spacing_m * (std::ceil(radius_m / trial.spacing_m) + 2);  // has a node at its centre
  const bool is_sheet = trial.structure == Structure::kSurface;
  body.source = is_sheet ? TissueSource::kSheet : TissueSource::kBox;
  body.structure = trial.structure;
  body.box_size_m = {side_m, side_m, trial.thickness_m};
  body.thickness_m = trial.thickness_m;
  body.spacing_m = trial.spacing_m;
  body.material.young_modulus_pa = kYoungModulus_pa;
  if (!is_sheet) body.material.poisson_ratio = trial.poisson_ratio;
  body.material.mass_damping_per_s = kDrag_per_s;
  body.material.prestress.strain = trial.strain;
  for (int side = 0; side < kSides; ++side) {
    const double angle = 2 * kPi * side / kSides;
    FixedConfig fixed;
    fixed.shape = FixedShape::kPlane;
    fixed.normal = {-std::cos(angle), -std::sin(angle), 0};
    fixed.point_m = -radius_m * fixed.normal;
    body.fixed.push_back(fixed);
  }
  scene.bodies.push_back(body);
  StylusConfig stylus;
  stylus.idle = ToolMode::kCut;
  stylus.cut.blade_length_m = 2 * trial.half_m;
  scene.styluses.push_back(stylus);
  scene.environment.gravity_m_per_s2.setZero();
  scene.solver.backend = Backend::kCpu;
  scene.solver.sleep_speed_m_per_s = 0;
  return scene;
}

double poissonOf(const SlitTrial& trial) {
  return trial.structure == Structure::kSurface ? 1.0 / 3 : trial.poisson_ratio;
}

/// Returns the opening in the centre [m]. The stress of a sheet with a prestrain e in both directions is
/// E e / (1 - nu).
double lawOf(const SlitTrial& trial) {
  const double nu = poissonOf(trial), kappa = (3 - nu) / (1 + nu);
  const double rim = (4 / (kappa - 1) + kappa + 3 / kappa) / 4;
  return 4 * trial.half_m * trial.strain / (1 - nu) / (1 + rim / (trial.radius * trial.radius));
}

class Slit {
 public:
  explicit Slit(const SlitTrial& trial)
      : trial_(trial), scene_(sceneOf(trial)), model_(buildModel(scene_)), solver_(model_, scene_) {}

  SlitResult run() {
    findRows();
    settle();
    SlitResult out;
    out.asked = lawOf(trial_);
    out.uncut = farthest() / out.asked;
    ToolMotions motions;
    motions[0].mode = ToolMode::kCut;
    motions[0].present = true;
    motions[0].from.orientation = Eigen::AngleAxisd(kPi / 2, Vector3d::UnitY());  // its z is x
    motions[0].to = motions[0].from;
    const double over_m = 0.5 * trial_.thickness_m + trial_.spacing_m;
    motions[0].from.position_m = {-trial_.half_m, 0.5 * (above_m_ + below_m_), over_m};
    motions[0].to.position_m = motions[0].from.position_m - 2 * over_m * Vector3d::UnitZ();
    solver_.step(motions);
    settle();
    const HostState state = solver_.readState();
    for (size_t i = 0; i < kSlitPositions.size(); ++i) {
      const double x = kSlitPositions[i] * trial_.half_m;
      const double law = out.asked * std::sqrt(1 - kSlitPositions[i] * kSlitPositions[i]);
      out.opening[i] = (sideAt(above_m_, x, state) - sideAt(below_m_, x, state)) / law;
    }
    out.nodes = model_.activeNodes();
    out.trips = static_cast<double>(solver_.health().trips);
    return out;
  }

 private:
  Vector3d rest(uint32_t slot) const { return restPosition(model_.bodies[0], slot); }
  const std::vector<uint32_t>& slots() const { return model_.bodies[0].lattice.active_slots; }

  /// Finds the rows of nodes on both sides of the blade's plane, which is as close to the centre as possible.
  void findRows() {
    const double close = 1e-3 * trial_.spacing_m;
    above_m_ = below_m_ = trial_.spacing_m;
    for (const uint32_t slot : slots()) {
      const double y = rest(slot).y();
      if (y >= -close) above_m_ = std::min(above_m_, y);
    }
    below_m_ = -trial_.spacing_m;
    for (const uint32_t slot : slots()) {
      const double y = rest(slot).y();
      if (y < above_m_ - close) below_m_ = std::max(below_m_, y);
    }
  }

  void settle() {
    const auto ticks = static_cast<long>(kSettle_s * scene_.solver.tick_hz);
    for (long k = 0; k < ticks; ++k) solver_.step({});
  }

  double farthest() const {
    const HostState state = solver_.readState();
    double out = 0;
    for (const uint32_t slot : slots()) {
      const layout::vec4& u = state.displacement_m[slot];
      out = std::max({out, static_cast<double>(std::abs(u.x)), static_cast<double>(std::abs(u.y))});
    }
    return out;
  }

  /// Returns the displacement along y of the row at y, at x: interpolated between its nodes, mean through the thickness
  /// [m].
  double sideAt(double y, double x, const HostState& state) const {
    double weights = 0, sum = 0;
    for (const uint32_t slot : slots()) {
      const Vector3d at = rest(slot);
      const double weight = 1 - std::abs(at.x() - x) / trial_.spacing_m;
      if (std::abs(at.y() - y) > 1e-3 * trial_.spacing_m || weight <= 0) continue;
      weights += weight;
      sum += weight * static_cast<double>(state.displacement_m[slot].y);
    }
    return sum / weights;
  }

  SlitTrial trial_;
  Scene scene_;
  Model model_;
  CpuSolver solver_;
  double above_m_ = 0, below_m_ = 0;
};

void addRow(const SlitTrial& trial, const std::string& name, Table& table, Report& report) {
  const double fine = trial.half_m / trial.spacing_m;
  const std::string row = name + ", a/h " + Cell(fine).text(3) + ", strain " + Cell(trial.strain).text(3);
  report.stage("slit in a " + row);
  const SlitResult r = openSlit(trial);
  table.add({name, fine, trial.spacing_m / trial.thickness_m, trial.strain, static_cast<double>(r.nodes), r.opening[0],
             r.opening[1], r.opening[2], r.uncut});
  if (fine >= kReasonable && trial.strain <= 0.01)
    report.checkAtMost("opening off the law, " + row, std::abs(r.opening[0] - 1), kOpening);
  report.checkAtMost("moved before the cut, " + row, r.uncut, kUncut);
  report.checkAtMost("trips, " + row, r.trips, 0);
}

}  // namespace

SlitResult openSlit(const SlitTrial& trial) {
  return Slit(trial).run();
}

void prestressSlits(Report& report) {
  Table table("A slit in a sheet with a prestress, opening over 4 sigma a / E sqrt(1 - x^2 / a^2)",
              {{"sheet"},
               {"a / h", "", 3},
               {"h / thickness", "", 2},
               {"strain", "", 2},
               {"nodes"},
               {"middle", "", 3},
               {"x = 0.5 a", "", 3},
               {"x = 0.8 a", "", 3},
               {"moved uncut", "", 2}});
  for (const double fine : {3.5, 6.5, 12.5, 24.5}) {  // the ends of the slit are half way between nodes
    if (report.isShort() && fine > 7) continue;
    SlitTrial trial;
    trial.spacing_m = trial.half_m / fine;
    addRow(trial, "triangles", table, report);
    if (fine > 13) continue;
    trial.structure = Structure::kLattice;
    trial.thickness_m = trial.spacing_m;  // and the rim is closer: these cost ten times as much
    trial.radius = 4;
    addRow(trial, "lattice", table, report);
    trial.poisson_ratio = 0.45;
    addRow(trial, "lattice, nu 0.45", table, report);
  }
  for (const double strain : {0.02, 0.05, 0.1}) {
    SlitTrial trial;
    trial.spacing_m = trial.half_m / (report.isShort() ? 6.5 : 12.5);
    trial.strain = strain;
    addRow(trial, "triangles", table, report);
  }
  report.add(table, "prestress");
}

}  // namespace viscera::bench
