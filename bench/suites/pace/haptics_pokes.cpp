// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/pace/haptics_pokes.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "bench/suites/pace/haptics_trial.h"

namespace viscera::bench {
namespace {

constexpr double kPokesActive_mj = 1;  ///< energy that the loop may give, in all
constexpr double kPokesTold_s = 0.002;

struct PokesMatrix {
  std::vector<double> young_kpa, delay_ms, mass_kg, poses_hz;
};

PokesMatrix pokesOf(bool short_form) {
  if (short_form) return {{60}, {10}, {0.2}, {1000, 100}};
  return {{10, 60}, {0, 2, 10}, {0.05, 0.2, 2}, {1000, 100, 60}};
}

Table pokesTable() {
  return Table("eight pokes of 9 mm at 0.12 m/s with the same ball, device and hand", {{"tissue", "kPa", 3},
                                                                                       {"delay", "ms", 3},
                                                                                       {"told", "ms", 3},
                                                                                       {"mass", "kg", 3},
                                                                                       {"poses", "Hz", 4},
                                                                                       {"first poke", "N", 3},
                                                                                       {"last poke", "N", 3},
                                                                                       {"simulator's", "N", 3},
                                                                                       {"least energy", "mJ", 2},
                                                                                       {"at the end", "mJ", 2},
                                                                                       {"observed", "mJ", 2},
                                                                                       {"by any delay", "mJ", 2},
                                                                                       {"share", "", 2}});
}

/// @param told_s  of every device; nothing: its own delay
/// @returns the least energy of all [mJ]
double measurePokes(Report& report, const PokesMatrix& matrix, const std::optional<double>& told_s, Table& table) {
  double least_mj = 0;
  HapticTrial trial;
  trial.told_delay_s = told_s;
  for (const double poses_hz : matrix.poses_hz) {
    trial.poses_hz = poses_hz;
    for (const double young : matrix.young_kpa) {
      trial.young_modulus_pa = 1e3 * young;
      for (const double delay : matrix.delay_ms) {
        trial.delay_s = delay / 1e3;
        report.stage("pokes, poses of " + Cell(poses_hz).text(4) + " Hz, " + Cell(young).text(3) + " kPa, " +
                     Cell(delay).text(3) + " ms");
        for (const double mass : matrix.mass_kg) {
          trial.mass_kg = mass;
          const PokeOutcome of = runPokes(trial, {});
          table.add({young, delay, 1e3 * told_s.value_or(trial.delay_s), mass, poses_hz, of.first_n, of.last_n,
                     of.simulator_n, of.least_energy_mj, of.given_mj, of.observed_mj, of.surely_mj, of.share});
          least_mj = std::min(least_mj, of.least_energy_mj);
        }
      }
    }
  }
  return least_mj;
}

}  // namespace

void hapticsPokes(Report& report) {
  Table table = pokesTable();
  const PokesMatrix matrix = pokesOf(report.isShort());
  const double least_mj = measurePokes(report, matrix, std::nullopt, table);
  PokesMatrix late = matrix;
  late.delay_ms = {10};
  const double wrong_mj = measurePokes(report, late, kPokesTold_s, table);
  report.add(table, "pokes");
  report.checkAtLeast("pokes, least energy that a device has given [mJ]", least_mj, -kPokesActive_mj);
  report.checkAtLeast("pokes, the same behind 10 ms that are told as 2 [mJ]", wrong_mj, -kPokesActive_mj);
}

}  // namespace viscera::bench
