// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Large bending: the ends of a beam are rotated until it is a circle.
#include <algorithm>
#include <cmath>

#include "bench/harness/experiment.h"
#include "bench/suites/material/material_parts.h"
#include "solver/reference/statics.h"

namespace viscera::bench {

namespace {

constexpr int kMaterialCircleSlenderness =
    40;                                ///< length over depth: strain of the outermost fibre is pi / 40 in a circle
constexpr int kSteps = 24;             ///< number of steps to the full circle
constexpr double kMomentLimit = 0.03;  ///< relative to E I kappa: our choice; fibres strained by 8 % are not linear
constexpr double kBalanced = 1e-4;     ///< relative to the largest force: Newton's last digits cost hundreds of steps
constexpr double kKernelLimit = 1e-3;  ///< kernels against the reference in the same state, float32 rounding

/// A beam along x, n cells deep and wide, bent about y.
class BentBeam {
 public:
  BentBeam(int depth, Law law) : depth_(depth), length_(kMaterialCircleSlenderness * depth), model_(modelOf(law)) {}

  /// Bends it by rotating its ends by half the angle each, in small steps. @return moment over E I kappa
  double bend(double angle) {
    while (angle_ < angle - 1e-9) {
      const double before = angle_;
      angle_ = std::min(angle, angle_ + 2 * M_PI / kSteps);
      for (uint32_t slot : solver_.active) {  // moves sections along the circle and keeps their other displacements
        const Vector3d rest = solver_.restPosition(slot);
        solver_.u_m[slot] += bentPosition(rest, angle_) - bentPosition(rest, before);
      }
      std::vector<PrescribedDof> ends;
      for (uint32_t slot : solver_.active) {
        const Vector3d rest = solver_.restPosition(slot);
        if (rest.x() > 1e-9 && rest.x() < length_ - 1e-9) continue;
        const Vector3d u = bentPosition(rest, angle_) - rest;
        // Sections stay plane and on their line; they are free to contract across and along y.
        ends.push_back({slot, 0, u.x()});
        ends.push_back({slot, 2, u.z()});
        if (std::abs(rest.y() - depth_ / 2.0) < 0.6) ends.push_back({slot, 1, 0});
      }
      StaticsOptions options;
      options.tolerance = kBalanced;
      solveStatics(solver_, ends, {}, options);
    }
    return momentOf(solver_.elasticForces(solver_.u_m));
  }
  double momentOn(Backend backend) const { return momentOf(forcesOn(backend, model_, solver_.u_m)); }

 private:
  Model modelOf(Law law) const {
    MaterialConfig material = unitMaterial();
    material.law = law;
    return blockModel({length_, depth_, depth_}, 1, material);
  }
  /// Maps a point onto a circle of curvature angle / length; the mid-plane keeps its length.
  Vector3d bentPosition(const Vector3d& rest, double angle) const {
    if (angle == 0) return rest;
    const double radius = length_ / angle, turn = (rest.x() / length_ - 0.5) * angle;
    const double r = radius + rest.z() - depth_ / 2.0;
    return {length_ / 2.0 + r * std::sin(turn), rest.y(), depth_ / 2.0 + r * std::cos(turn) - radius};
  }
  /// Returns the moment about y on the end at x = length, over E I kappa.
  double momentOf(const Field& force_n) const {
    Vector3d middle = Vector3d::Zero(), moment = Vector3d::Zero();
    int count = 0;
    for (uint32_t slot : solver_.active) {
      if (solver_.restPosition(slot).x() < length_ - 1e-9) continue;
      middle += solver_.restPosition(slot) + solver_.u_m[slot];
      ++count;
    }
    middle /= count;
    for (uint32_t slot : solver_.active) {
      if (solver_.restPosition(slot).x() < length_ - 1e-9) continue;
      moment -= (solver_.restPosition(slot) + solver_.u_m[slot] - middle).cross(force_n[slot]);
    }
    const double inertia = std::pow(depth_, 4) / 12.0;
    return std::abs(moment.y()) / (unitMaterial().young_modulus_pa * inertia * angle_ / length_);
  }

  int depth_, length_;
  Model model_;
  ReferenceSolver solver_{model_, Vector3d::Zero(), 1};
  double angle_ = 0;
};

}  // namespace

void measureCircle(Report& report) {
  std::vector<Column> columns = {{"cells"}, {"depth"}, {"turned by", "deg"}, {"M/(E I kappa)", "", 5}};
  for (Backend backend : report.backends()) columns.push_back({nameOf(backend) + ": M/M_float64 - 1", "", 2});
  Table table("A beam 40 times as long as deep, bent into a circle by its ends", columns);
  std::vector<double> worst_kernel(report.backends().size());
  for (Law law : {Law::kSprings, Law::kNeoHookean}) {
    const std::string name = nameOf(law);
    double worst = 0;
    for (int depth : report.isShort() ? std::vector<int>{1} : std::vector<int>{1, 2}) {
      report.stage("circle, " + name + ", depth " + std::to_string(depth));
      BentBeam beam(depth, law);
      for (double degrees : {45.0, 180.0, 360.0}) {
        std::vector<Cell> row = {name, depth, degrees};
        double moment = std::nan("");
        try {
          moment = beam.bend(degrees * M_PI / 180);
        } catch (const ConvergenceError& error) {
          report.note("circle, " + name + ", " + Cell(degrees).text(3) + " degrees: " + error.what());
        }
        row.push_back(std::isnan(moment) ? Cell("no equilibrium") : Cell(moment));
        for (size_t b = 0; b < worst_kernel.size(); ++b) {
          const double on = std::isnan(moment) ? 0 : beam.momentOn(report.backends()[b]) / moment - 1;
          row.push_back(std::isnan(moment) ? Cell("") : Cell(on));
          worst_kernel[b] = worse(worst_kernel[b], std::abs(on));
        }
        table.add(row);
        worst = worse(worst, std::abs(moment - 1));
        if (std::isnan(moment)) break;
      }
    }
    if (law == Law::kNeoHookean && !report.isShort())
      report.checkAtMost("circle, neo_hookean: largest |M/(E I kappa) - 1|", worst, kMomentLimit);
  }
  report.add(table, "circle");
  for (size_t b = 0; b < worst_kernel.size(); ++b) {
    report.checkAtMost("circle, forces of " + nameOf(report.backends()[b]) + ": moment over float64's, less 1",
                       worst_kernel[b], kKernelLimit);
  }
}

}  // namespace viscera::bench
