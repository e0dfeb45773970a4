// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/blade/blade_structures.h"

#include <cmath>
#include <string>

#include "bench/suites/blade/blade_trial.h"

namespace viscera::bench {

namespace {

constexpr double kForce = 0.05;    // relative to the law's force
constexpr double kRipple = 0.1;    // relative to J w
constexpr double kLeastDet = 0.1;  // for a whole cell or triangle: nothing is inverted
constexpr double kWork = 0.02;     // share of the work that is not cutting, elastic, kinetic or damping
constexpr double kBladeStructuresMilli = 1e-3;
constexpr double kToughness_j_per_m2 = 100;
constexpr double kSheet_m = 0.001;  // thickness

struct Kind {
  const char* name;
  Structure structure;
};
constexpr Kind kKinds[] = {{"explicit", Structure::kExplicit}, {"sheet", Structure::kSurface}};

BladeTrial trialOf(const Kind& kind, double spacing_m, double carried, double angle_deg) {
  BladeTrial trial;
  trial.structure = kind.structure;
  trial.spacing_m = spacing_m;
  trial.toughness_j_per_m2 = kToughness_j_per_m2;
  trial.young_modulus_pa = kToughness_j_per_m2 / (carried * spacing_m);
  trial.angle_deg = angle_deg;
  if (spacing_m > 0.002) {  // a kernel is nine springs wide: the block and the stroke are enlarged
    trial.length_m = 0.09;
    trial.width_m = 0.072;
    trial.stroke_m = 0.0675;
  }
  if (angle_deg > 0) trial.beside = 0.31;
  if (kind.structure == Structure::kSurface) trial.thickness_m = kSheet_m;
  return trial;
}

void addRow(const Kind& kind, const BladeTrial& trial, Table& table, Report& report) {
  const auto text = [](double value) { return Cell(value).text(3); };
  const BladeResult r = cutThrough(trial);
  const double balance = r.cut_share + r.stored_share + r.damped_share;
  const double carried = trial.toughness_j_per_m2 / (trial.young_modulus_pa * r.length_m);
  const std::string name = std::string(kind.name) + ", h " + text(r.length_m / kBladeStructuresMilli) +
                           " mm, J/(E h) " + text(carried) + ", " + text(trial.angle_deg) + " deg";
  table.add({kind.name, r.length_m / kBladeStructuresMilli, carried, trial.angle_deg, r.force, r.asked,
             r.ripple * r.force, r.onset_m / kBladeStructuresMilli, r.cut_share, r.stored_share, r.damped_share,
             balance, r.worst_det});
  report.checkAtMost("force off the law, " + name, std::abs(r.force - 1), kForce);
  report.checkAtMost("ripple, " + name, r.ripple * r.force, kRipple);
  report.checkAtLeast("least volume, " + name, r.worst_det, kLeastDet);
  report.checkAtMost("work not accounted for, " + name, std::abs(1 - balance), kWork);
  report.checkAtMost("trips, " + name, r.trips, 0);
}

}  // namespace

void bladeStructures(Report& report) {
  Table table("By structure", {{"structure"},
                               {"h", "mm"},
                               {"J/(E h)", "", 3},
                               {"angle", "deg"},
                               {"force / law"},
                               {"force / J w", "", 3},
                               {"ripple / J w", "", 2},
                               {"onset", "mm", 3},
                               {"parting / work"},
                               {"stored / work", "", 2},
                               {"damped / work", "", 2},
                               {"all / work"},
                               {"least volume", "", 3}});
  for (const Kind& kind : kKinds) {
    for (const double spacing_m : {0.004, 0.002}) {
      if (report.isShort() && spacing_m < 0.004) continue;
      report.stage(std::string(kind.name) + " at " + Cell(spacing_m / kBladeStructuresMilli).text(3) + " mm");
      for (const double carried : {0.5, 2.0, 10.0}) addRow(kind, trialOf(kind, spacing_m, carried, 0), table, report);
      for (const double angle_deg : {10.0, 30.0, 45.0})
        if (spacing_m < 0.004) addRow(kind, trialOf(kind, spacing_m, 2, angle_deg), table, report);
    }
  }
  report.add(table, "structures");
}

}  // namespace viscera::bench
