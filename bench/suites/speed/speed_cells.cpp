// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/rate.h"
#include "bench/suites/speed/speed_parts.h"

namespace viscera::bench {

namespace {

constexpr double kDearer = 1.6;  // a substep with moments over one with springs alone
// Over spacing, of the wave that bodies start with: small enough that moments, in which light nodes outside swing
// farther, have no springs so strained that they need a formula of their own. Tissue's motion is not compared.
constexpr double kWave = 0.002;

/// A body with cells by moments, and the same lattice with springs alone.
struct Pair {
  Specimen moments, springs;
};
Pair pairOf(const std::string& name, Specimen specimen) {
  specimen.name = name;
  specimen.start = wobbling(specimen.model, kWave * specimen.model.bodies[0].lattice.spacing_m, 1);
  Pair out{specimen, std::move(specimen)};
  out.moments.model.bodies[0].material.cells = Cells::kMoments;
  out.springs.model.bodies[0].material.cells = Cells::kSprings;
  return out;
}

/// A heart that fills its surface: most of its cells are tissue in part.
Specimen filledHeart(int nodes) {
  MaterialConfig material = specimenMaterial();
  material.cells = Cells::kMoments;
  return heartOf(nodes, material);
}

std::vector<Pair> pairsOf(bool short_form) {
  if (short_form) return {pairOf("cube, full cells", cubeOf(12)), pairOf("heart", filledHeart(2000))};
  return {pairOf("cube, full cells", cubeOf(35)), pairOf("heart", filledHeart(13000)),
          pairOf("heart", filledHeart(42745))};
}

/// Cells that are tissue in part, of all.
double partialShare(const Model& model) {
  const Lattice& lattice = model.bodies[0].lattice;
  size_t cells = 0;
  for (const uint8_t label : lattice.cell_labels) cells += label != 0 ? 1 : 0;
  return static_cast<double>(lattice.fills.size()) / static_cast<double>(cells);
}

}  // namespace

void measureCells(Report& report) {
  Table table("cells by moments, and springs alone on the same lattice", {{"body"},
                                                                          {"nodes", "", 8},
                                                                          {"cells in part", "", 2},
                                                                          {"backend"},
                                                                          {"moments", "ns/update"},
                                                                          {"springs", "ns/update"},
                                                                          {"moments over springs", "", 3},
                                                                          {"spread", "", 2}});
  // Rounds are short and many: what else a machine does falls on both of a pair alike.
  const std::vector<std::pair<std::string, std::function<std::shared_ptr<Ticks>(const Specimen&)>>> ways = {
      {"cpu, 1 thread", [](const Specimen& specimen) { return onCpu(specimen, 1); }},
      {"cpu, all threads", [](const Specimen& specimen) { return onCpu(specimen); }},
      {"gpu", onGpu}};
  for (const Pair& pair : pairsOf(report.isShort())) {
    const size_t nodes = pair.springs.nodes();
    report.stage("cells of a " + pair.moments.name + " of " + std::to_string(nodes) + " nodes");
    for (const auto& [way, on] : ways) {
      const std::vector<Rate> rates =
          measureRates({candidate("", on(pair.moments), nodes), candidate("", on(pair.springs), nodes)},
                       report.isShort() ? 0.01 : 0.03, report.isShort() ? 5 : 25);
      const Rate &moments = rates[0], &springs = rates[1];
      const double ratio = moments.ns_per_update() / springs.ns_per_update();
      table.add({pair.moments.name, static_cast<double>(nodes), partialShare(pair.moments.model), way,
                 moments.ns_per_update(), springs.ns_per_update(), ratio, std::max(moments.spread, springs.spread)});
      if (way == "gpu") continue;
      report.checkAtMost("cells by moments: a substep over one of springs alone, " + pair.moments.name + " of " +
                             std::to_string(nodes) + ", " + way,
                         ratio, kDearer);
    }
  }
  report.add(table, "cells");
}

}  // namespace viscera::bench
