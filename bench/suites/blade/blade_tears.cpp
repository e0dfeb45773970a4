// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/blade/blade_tears.h"

#include <cmath>
#include <string>

#include "bench/suites/blade/tear_trial.h"

namespace viscera::bench {

namespace {

constexpr double kOff = 0.15;  // relative to the given toughness
constexpr double kBladeTearsMilli = 1e-3;
constexpr double kSpacings_m[] = {0.004, 0.002, 0.001};

std::string nameOf(const TearTrial& trial) {
  const auto text = [](double value) { return Cell(value).text(3); };
  return "h " + text(trial.spacing_m / kBladeTearsMilli) + " mm, G " + text(trial.toughness_j_per_m2) + " J/m2";
}
double carriedOf(const TearTrial& trial) {
  return trial.toughness_j_per_m2 / (trial.young_modulus_pa * trial.spacing_m);
}

void strips(Report& report) {
  Table table("A notched strip goes on at an energy release",
              {{"h", "mm"}, {"G", "J/m2"}, {"G/(E h)", "", 3}, {"strain", "", 3}, {"release / G", "", 3}, {"crumbs"}});
  for (const double toughness_j_per_m2 : {5.0, 20.0, 80.0}) {
    for (const double spacing_m : kSpacings_m) {
      if (report.isShort() && spacing_m < 0.004) continue;
      TearTrial trial;
      trial.spacing_m = spacing_m;
      trial.toughness_j_per_m2 = toughness_j_per_m2;
      report.stage("strip, " + nameOf(trial));
      const StripResult r = pullStrip(trial);
      table.add({spacing_m / kBladeTearsMilli, toughness_j_per_m2, carriedOf(trial), r.strain, r.release,
                 static_cast<double>(r.crumbs)});
      report.checkAtMost("release off G, " + nameOf(trial), std::abs(r.release - 1), kOff);
    }
  }
  report.add(table, "tear_strips");
}

void trousers(Report& report) {
  Table table("Trouser test", {{"h", "mm"},
                               {"G", "J/m2"},
                               {"G/(E h)", "", 3},
                               {"force / (G t/2)", "", 3},
                               {"least", "", 3},
                               {"most", "", 3},
                               {"crumbs"},
                               {"trips"}});
  for (const double toughness_j_per_m2 : {20.0, 40.0}) {
    for (const double spacing_m : kSpacings_m) {
      if (report.isShort() && spacing_m < 0.004) continue;
      TearTrial trial;
      trial.spacing_m = spacing_m;
      trial.toughness_j_per_m2 = toughness_j_per_m2;
      report.stage("trousers, " + nameOf(trial));
      const TrouserResult r = pullTrousers(trial);
      table.add({spacing_m / kBladeTearsMilli, toughness_j_per_m2, carriedOf(trial), r.force, r.least, r.most,
                 static_cast<double>(r.crumbs), r.trips});
      report.checkAtMost("trouser force off the law, " + nameOf(trial), std::abs(r.force - 1), kOff);
      report.checkAtMost("trips, trousers, " + nameOf(trial), r.trips, 0);
    }
  }
  report.add(table, "tear_trousers");
}

}  // namespace

void bladeTears(Report& report) {
  strips(report);
  trousers(report);
}

}  // namespace viscera::bench
