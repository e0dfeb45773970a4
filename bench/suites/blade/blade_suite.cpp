// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/blade/blade_suite.h"

#include <cmath>

#include "bench/suites/blade/blade_curves.h"
#include "bench/suites/blade/blade_strokes.h"
#include "bench/suites/blade/blade_structures.h"
#include "bench/suites/blade/blade_tears.h"
#include "bench/suites/blade/blade_trial.h"
#include "bench/suites/blade/prestress_slit.h"

namespace viscera::bench {

namespace {

constexpr double kBladeForce = 0.05;    // relative to the law's force
constexpr double kBladeRipple = 0.1;    // relative to J w
constexpr double kBladeLeastDet = 0.1;  // for a whole cell: nothing is inverted
constexpr double kBladeWork = 0.02;     // share of the work that is not cutting, elastic, kinetic or damping
constexpr double kCost = 0.1;           // relative to a tick
constexpr double kBackends = 0.01;      // relative to the force: on the GPU substeps follow the stretch one tick later
constexpr double kBladeKilo = 1e3, kBladeMilli = 1e-3;

Table forceTable(const std::string& title) {
  return Table(title, {{"h", "mm"},
                       {"E", "kPa"},
                       {"J", "J/m2"},
                       {"J/(E h)", "", 3},
                       {"angle", "deg"},
                       {"speed", "m/s"},
                       {"xi", ""},
                       {"force / law"},
                       {"force / J w", "", 3},
                       {"along / J w", "", 3},
                       {"ripple / J w", "", 2},
                       {"onset", "mm", 3},
                       {"parting / work"},
                       {"stored / work", "", 2},
                       {"damped / work", "", 2},
                       {"all / work"},
                       {"least det F", "", 3}});
}

/// Returns J w / (1 + xi^2), with the J that the lattice represents.
double lawOf(const BladeTrial& trial) {
  return 1 / (1 + trial.slicing * trial.slicing);
}

std::string trialName(const BladeTrial& trial) {
  const auto text = [](double value) { return Cell(value).text(3); };
  return "h " + text(trial.spacing_m / kBladeMilli) + " mm, E " + text(trial.young_modulus_pa / kBladeKilo) + " kPa, " +
         text(trial.angle_deg) + " deg, " + text(trial.speed_m_per_s) + " m/s, xi " + text(trial.slicing);
}

void addRow(const BladeTrial& trial, Table& table, Report& report) {
  report.stage(trialName(trial));
  const BladeResult r = cutThrough(trial);
  const double balance = r.cut_share + r.stored_share + r.damped_share;
  const double unit = trial.young_modulus_pa * trial.spacing_m, over_law = r.force / lawOf(trial);
  table.add({trial.spacing_m / kBladeMilli, trial.young_modulus_pa / kBladeKilo, trial.toughness_j_per_m2,
             trial.toughness_j_per_m2 / unit, trial.angle_deg, trial.speed_m_per_s, trial.slicing, over_law, r.asked,
             r.along, r.ripple * r.force, r.onset_m / kBladeMilli, r.cut_share, r.stored_share, r.damped_share, balance,
             r.worst_det});
  report.checkAtMost("force off the law, " + trialName(trial), std::abs(over_law - 1), kBladeForce);
  report.checkAtMost("ripple, " + trialName(trial), r.ripple * r.force, kBladeRipple);
  report.checkAtLeast("least det F, " + trialName(trial), r.worst_det, kBladeLeastDet);
  report.checkAtMost("work not accounted for, " + trialName(trial), std::abs(1 - balance), kBladeWork);
  report.checkAtMost("trips, " + trialName(trial), r.trips, 0);
}

void spacings(Report& report) {
  Table table = forceTable("Liver's toughness by spacing and Young's modulus");
  for (const double spacing_m : {0.004, 0.002, 0.001}) {
    if (report.isShort() && spacing_m < 0.004) continue;
    for (const double young_modulus_pa : {100e3, 50e3, 20e3, 10e3, 5e3, 2e3}) {
      BladeTrial trial;
      trial.spacing_m = spacing_m;
      trial.young_modulus_pa = young_modulus_pa;
      trial.toughness_j_per_m2 = 200;
      if (spacing_m < 0.002) {
        trial.length_m = 0.04;
        trial.width_m = 0.032;
        trial.stroke_m = 0.03;
      }
      addRow(trial, table, report);
    }
  }
  report.add(table, "spacings");
}

void angles(Report& report) {
  Table table = forceTable("By the angle between the cut and the lattice");
  for (const double toughness_j_per_m2 : {100.0, 200.0}) {
    for (const double angle_deg : {0.0, 10.0, 20.0, 30.0, 45.0}) {
      BladeTrial trial;
      trial.spacing_m = report.isShort() ? 0.004 : 0.002;
      trial.young_modulus_pa = report.isShort() ? 20e3 : 40e3;
      trial.toughness_j_per_m2 = toughness_j_per_m2;
      trial.angle_deg = angle_deg;
      trial.beside = 0.31;
      addRow(trial, table, report);
    }
  }
  report.add(table, "angles");
}

void speeds(Report& report) {
  Table table = forceTable("By speed");
  for (const double speed_m_per_s : {0.001, 0.01, 0.1, 0.3, 1.0}) {
    if (report.isShort() && speed_m_per_s < 0.01) continue;
    BladeTrial trial;
    trial.spacing_m = 0.004;
    trial.toughness_j_per_m2 = 100;
    trial.speed_m_per_s = speed_m_per_s;
    addRow(trial, table, report);
  }
  report.add(table, "speeds");
}

void slices(Report& report) {
  Table table = forceTable("By slicing: displacement of the edge along itself over that across it");
  for (const double spacing_m : {0.004, 0.002}) {
    if (report.isShort() && spacing_m < 0.004) continue;
    for (const double slicing : {0.0, 0.5, 1.0, 2.0}) {
      BladeTrial trial;
      trial.spacing_m = spacing_m;
      trial.young_modulus_pa = 80 / spacing_m;
      trial.toughness_j_per_m2 = 100;
      trial.slicing = slicing;
      addRow(trial, table, report);
    }
  }
  report.add(table, "slicing");
}

/// Compares with the same blade where tissue does not resist it.
void cost(Report& report) {
  Table table("A substep while a blade cuts",
              {{"nodes"}, {"J/(E h)", "", 3}, {"resisted", "us"}, {"not", "us"}, {"more", "", 2}});
  for (const double toughness_j_per_m2 : {40.0, 100.0, 200.0}) {
    BladeTrial trial;
    trial.young_modulus_pa = 40e3;
    trial.toughness_j_per_m2 = toughness_j_per_m2;
    trial.length_m = trial.width_m = 0.08;
    trial.thickness_m = 0.024;
    trial.stroke_m = 0.03;
    trial.damped = false;
    report.stage("cost at J " + Cell(toughness_j_per_m2).text(3));
    const BladeResult resisted = cutThrough(trial);
    trial.toughness_j_per_m2 = 0;
    const BladeResult free = cutThrough(trial);
    const double more = resisted.substep_us / free.substep_us - 1;
    table.add(
        {static_cast<double>(resisted.nodes), toughness_j_per_m2 / 80, resisted.substep_us, free.substep_us, more});
    report.checkAtMost("cost at J " + Cell(toughness_j_per_m2).text(3), more, kCost);
  }
  report.add(table, "cost");
}

void addPair(const char* structure, BladeTrial trial, Table& table, Report& report) {
  const double carried = trial.toughness_j_per_m2 / (trial.young_modulus_pa * trial.spacing_m);
  const std::string of = std::string(structure) + " at " + Cell(trial.spacing_m / kBladeMilli).text(3) +
                         " mm, J/(E h) " + Cell(carried).text(3);
  report.stage(of + " on both backends");
  const BladeResult cpu = cutThrough(trial);
  trial.backend = Backend::kGpu;
  const BladeResult gpu = cutThrough(trial);
  trial.toughness_j_per_m2 = 0;
  const double free_us = cutThrough(trial).fastest_us;
  trial.there = false;
  table.add({structure, trial.spacing_m / kBladeMilli, static_cast<double>(gpu.nodes), carried, gpu.force, cpu.force,
             cutThrough(trial).fastest_us, free_us, gpu.fastest_us});
  report.checkAtMost("force off the law on the GPU, " + of, std::abs(gpu.force - 1), kBladeForce);
  report.checkAtMost("GPU off the CPU, " + of, std::abs(gpu.force - cpu.force), kBackends);
  report.checkAtMost("trips on the GPU, " + of, gpu.trips, 0);
}

/// Measures the law and the cost of a substep until its measurements arrive, in the fastest tick.
void onTheGpu(Report& report) {
  Table table("On the GPU backend", {{"structure"},
                                     {"h", "mm"},
                                     {"nodes"},
                                     {"J/(E h)", "", 3},
                                     {"force / law"},
                                     {"on the CPU"},
                                     {"no blade", "us"},
                                     {"not resisted", "us"},
                                     {"resisted", "us"}});
  BladeTrial trial;
  trial.spacing_m = 0.004;
  trial.toughness_j_per_m2 = 100;
  addPair("lattice", trial, table, report);
  trial.structure = Structure::kSurface;
  trial.thickness_m = 0.001;
  addPair("sheet", trial, table, report);
  for (const double toughness_j_per_m2 : {40.0, 100.0, 200.0}) {
    if (report.isShort()) break;
    BladeTrial fine;
    fine.young_modulus_pa = 40e3;
    fine.toughness_j_per_m2 = toughness_j_per_m2;
    addPair("lattice", fine, table, report);
  }
  report.add(table, "gpu");
}

}  // namespace

void bladeSuite(Report& report) {
  measureParts(report, {{"spacings", spacings},
                        {"angles", angles},
                        {"speeds", speeds},
                        {"slicing", slices},
                        {"structures", bladeStructures},
                        {"prestress", prestressSlits},
                        {"strokes", bladeStrokes},
                        {"onset", bladeOnset},
                        {"hand", bladeTool},
                        {"tear", bladeTears},
                        {"cost", cost},
                        {"gpu", onTheGpu}});
}

}  // namespace viscera::bench
