// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/pace/haptics_suite.h"

#include <algorithm>
#include <string>
#include <vector>

#include "bench/suites/pace/haptics_blade.h"
#include "bench/suites/pace/haptics_trial.h"

namespace viscera::bench {
namespace {

/// Limits for every cell of the matrix.
constexpr double kStaticError = 0.02;      ///< relative to the simulator's force
constexpr double kLeastForce_n = 0.05;     ///< least held force of needles and sutures that is checked
constexpr double kFree_n = 0.05;           ///< largest force in free motion
constexpr double kHapticsActive_mj = 1;    ///< energy that the loop may give in addition to what it received
constexpr double kHapticsSwift_hz = 1000;  ///< rate of a driver that is as fast as the loop
/// An oscillation that exceeds both is a limit cycle: the threshold of a fingertip, and two steps of the encoder.
constexpr double kSwing_n = 0.05, kSwing_mm = 0.02;

bool cycles(const HapticOutcome& outcome) {
  return outcome.swing_n > kSwing_n && outcome.swing_mm > kSwing_mm;
}

struct Matrix {
  std::vector<double> young_kpa, delay_ms, mass_kg, poses_hz;
  std::vector<HapticEvent> events = {HapticEvent::kNone};
};

const std::vector<double> kPoses_hz = {1000, 250, 100, 60};

/// Largest Young's modulus [kPa]: the ball feels it as 660 N/m, for which the loop is designed. Stiffer tissue needs a
/// fast driver (docs/haptics.md 6).
constexpr double kStiffest_kpa = 60;

/// Returns every device and every tissue, with drivers of four rates.
Matrix matrixOf(bool short_form) {
  if (short_form) return {{1, kStiffest_kpa}, {0, 10}, {0.05, 2}, {1000, 100}};
  return {{1, 10, 30, kStiffest_kpa}, {0, 2, 5, 10}, {0.05, 0.2, 0.7, 2}, kPoses_hz};
}

/// Returns the events during contact.
Matrix eventsOf(bool short_form) {
  const std::vector<HapticEvent> all = {HapticEvent::kStall, HapticEvent::kLeap, HapticEvent::kClutch,
                                        HapticEvent::kPokes, HapticEvent::kUnheard};
  if (short_form) return {{kStiffest_kpa}, {2}, {0.1}, {1000, 100}, all};
  return {{10, kStiffest_kpa}, {2, 10}, {0.1, 0.7}, kPoses_hz, all};
}

Table tableOf(const std::string& title) {
  return Table(title, {{"tissue", "kPa", 3},
                       {"delay", "ms", 3},
                       {"mass", "kg", 3},
                       {"poses", "Hz", 4},
                       {"event"},
                       {"depth", "mm", 3},
                       {"force", "N", 3},
                       {"simulator's", "N", 3},
                       {"static error", "%", 2},
                       {"felt", "N/m", 3},
                       {"swing", "N", 2},
                       {"swing of tip", "mm", 2},
                       {"limit cycle"},
                       {"least energy", "mJ", 2},
                       {"observed", "mJ", 2},
                       {"unheard", "mJ", 2},
                       {"free", "N", 2},
                       {"share", "", 2}});
}

void add(Table& table, const HapticTrial& trial, const HapticOutcome& outcome, const char* event) {
  table.add({trial.young_modulus_pa / 1e3, 1e3 * trial.delay_s, trial.mass_kg, trial.poses_hz, event, outcome.depth_mm,
             outcome.force_n, outcome.simulator_n,
             outcome.simulator_n > 0 ? Cell(100 * outcome.static_error) : Cell(""), outcome.stiffness_n_per_m,
             outcome.swing_n, outcome.swing_mm, cycles(outcome) ? "yes" : "no", outcome.least_energy_mj,
             outcome.observed_mj, outcome.unheard_mj, outcome.free_n, outcome.stiffness_scale});
}

/// The worst of all cells.
struct Worst {
  double error = 0, free_n = 0;
  double swift_mj = 0;  ///< least energy with a driver as fast as the loop
  double least_mj = 0;  ///< least energy with any driver, beyond what no loop could avoid
  int cycling = 0;
  void record(double poses_hz, const HapticOutcome& outcome) {
    error = std::max(error, outcome.static_error);
    free_n = std::max(free_n, outcome.free_n);
    if (poses_hz >= kHapticsSwift_hz) swift_mj = std::min(swift_mj, outcome.least_energy_mj);
    least_mj = std::min(least_mj, outcome.least_energy_mj + outcome.unheard_mj);
    cycling += cycles(outcome);
  }
};

/// Measures one tissue with one delay and one driver, for all masses.
void measure(const Matrix& matrix, const HapticTrial& of_all, Table& table, Worst& worst, Series& series) {
  for (double mass : matrix.mass_kg) {
    HapticTrial trial = of_all;
    trial.mass_kg = mass;
    const HapticOutcome outcome = runHapticTrial(trial);
    add(table, trial, outcome, nameOf(trial.event));
    worst.record(trial.poses_hz, outcome);
    series.x.push_back(mass);
    series.y.push_back(outcome.swing_n);
  }
}

/// Measures all cells at a rate.
/// @param swings  plot of the stiffest tissue with the fastest driver, a curve per delay
Worst measure(Report& report, const Matrix& matrix, double rate_hz, Table& table, Plot& swings) {
  Worst worst;
  HapticTrial trial;
  trial.rate_hz = rate_hz;
  for (HapticEvent event : matrix.events) {
    trial.event = event;
    for (double poses_hz : matrix.poses_hz) {
      trial.poses_hz = poses_hz;
      for (double young : matrix.young_kpa) {
        trial.young_modulus_pa = 1e3 * young;
        for (double delay : matrix.delay_ms) {
          trial.delay_s = delay / 1e3;
          Series series;
          series.name = Cell(delay).text(3) + (rate_hz > 0 ? " ms" : " ms, once per tick");
          report.stage(std::string(nameOf(event)) + ", poses of " + Cell(poses_hz).text(4) + " Hz, " +
                       Cell(young).text(3) + " kPa, " + series.name);
          measure(matrix, trial, table, worst, series);
          const bool shown = event == HapticEvent::kNone && poses_hz == matrix.poses_hz.front();
          if (shown && young == matrix.young_kpa.back()) swings.series.push_back(series);
        }
      }
    }
  }
  return worst;
}

/// Returns fewer cells than for a probe, since a trial has three or more holds.
Matrix sutureOf(bool short_form) {
  if (short_form) return {{100}, {10}, {0.1, 2}, {1000, 100}};
  return {{1, 10, 100}, {0, 2, 10}, {0.05, 0.2, 2}, {1000, 100}};
}

/// Measures a needle or a suture at all stages of its stroke. Forces that are too small to feel have no relative error.
Worst measureSuture(Report& report, HapticTool tool, const char* name, Table& table) {
  Worst worst;
  const Matrix matrix = sutureOf(report.isShort());
  HapticTrial trial;
  trial.tool = tool;
  for (double poses_hz : matrix.poses_hz) {
    trial.poses_hz = poses_hz;
    for (double young : matrix.young_kpa) {
      trial.young_modulus_pa = 1e3 * young;
      for (double delay : matrix.delay_ms) {
        trial.delay_s = delay / 1e3;
        for (double mass : matrix.mass_kg) {
          trial.mass_kg = mass;
          report.stage(std::string(name) + ", poses of " + Cell(poses_hz).text(4) + " Hz, " + Cell(young).text(3) +
                       " kPa, " + Cell(delay).text(3) + " ms, " + Cell(mass).text(3) + " kg");
          for (const HapticStage& stage : runSutureTrial(trial)) {
            HapticOutcome outcome = stage.outcome;
            add(table, trial, outcome, stage.name);
            if (!stage.held || outcome.simulator_n < kLeastForce_n) outcome.static_error = 0;
            worst.record(trial.poses_hz, outcome);
          }
        }
      }
    }
  }
  return worst;
}

void suture(Report& report, HapticTool tool, const char* name, const std::string& title) {
  Table table = tableOf(title);
  const Worst worst = measureSuture(report, tool, name, table);
  report.add(table, name);
  const std::string what = std::string(name) + ", ";
  report.checkAtMost(what + "holds with a limit cycle", worst.cycling, 0);
  report.checkAtMost(what + "static force off the simulator's [1]", worst.error, kStaticError);
  report.checkAtLeast(what + "least energy that a device has given, poses of 1000 Hz [mJ]", worst.swift_mj,
                      -kHapticsActive_mj);
  report.checkAtLeast(what + "the same, any poses, beyond the delay of the loop [mJ]", worst.least_mj,
                      -kHapticsActive_mj);
  report.checkAtMost(what + "force in free motion [N]", worst.free_n, kFree_n);
}

void needle(Report& report) {
  suture(
      report, HapticTool::kNeedle, "needle",
      "the same device leads a needle of 20 mm through 9 mm of tissue: held at the skin, inside, through both skins, "
      "and drawn back out");
}

void suture(Report& report) {
  suture(report, HapticTool::kSuture, "suture",
         "the same device pulls a suture, its other end held, against a bite of six channels in 9 mm of tissue");
}

void probe(Report& report) {
  Plot swings;
  swings.title = "remaining oscillation of a held device, tissue of 60 kPa";
  swings.x_label = "mass of the device [kg]";
  swings.y_label = "half of peak to peak [N]";
  swings.log_x = swings.log_y = true;

  Table table = tableOf(
      "a simulated device in a hand (300 N/m, 4 N s/m) presses a ball of 8 mm into 20 mm of tissue on bone; "
      "ticks of 60 Hz, the local model at 1 kHz");
  const Worst worst = measure(report, matrixOf(report.isShort()), 1000, table, swings);
  report.add(table, "matrix");

  Plot none;
  Table befallen = tableOf(
      "events in contact: 150 ms without ticks and the hand 3 cm away; the base 15 mm "
      "higher and back; the clutch; eight pokes of 9 mm at 0.12 m/s before the holds; a driver that stops for 150 ms");
  const Worst events = measure(report, eventsOf(report.isShort()), 1000, befallen, none);
  report.add(befallen, "events");

  Table plain = tableOf("the first, with the forces of ticks, once per tick");
  const Matrix some = report.isShort() ? Matrix{{kStiffest_kpa}, {0}, {0.05}, {1000}}
                                       : Matrix{{10, kStiffest_kpa}, {0, 10}, {0.05, 0.2, 0.7, 2}, {1000}};
  const Worst without = measure(report, some, 0, plain, swings);
  report.add(plain, "once_per_tick");
  report.add(swings, "swings");

  report.checkAtMost("cells of the matrix with a limit cycle", worst.cycling, 0);
  report.checkAtMost("static force off the simulator's [1]", worst.error, kStaticError);
  report.checkAtLeast("least energy that a device has given, poses of 1000 Hz [mJ]", worst.swift_mj,
                      -kHapticsActive_mj);
  report.checkAtLeast("the same, any poses, beyond the delay of the loop [mJ]", worst.least_mj, -kHapticsActive_mj);
  report.checkAtMost("force in free motion [N]", worst.free_n, kFree_n);
  report.checkAtMost("limit cycles after events", events.cycling, 0);
  report.checkAtMost("static force off the simulator's after events [1]", events.error, kStaticError);
  report.checkAtLeast("least energy in events, beyond the delay of the loop [mJ]", events.least_mj, -kHapticsActive_mj);
  report.checkAtLeast("limit cycles without the local model, of those tested", without.cycling, 1);
}

}  // namespace

void hapticsSuite(Report& report) {
  measureParts(report, {{"probe", probe}, {"blade", hapticsBlade}, {"needle", needle}, {"suture", suture}});
}

}  // namespace viscera::bench
