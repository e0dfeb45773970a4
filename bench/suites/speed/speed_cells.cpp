// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/rate.h"
#include "bench/suites/speed/speed_parts.h"

namespace viscera::bench {

namespace {

constexpr double kDearer = 1.6;  // a substep of the law relative to springs

/// A body of the law, and one of springs of the same size.
struct Pair {
  Specimen law, springs;
};

MaterialConfig lawMaterial() {
  MaterialConfig material = specimenMaterial();
  material.law = Law::kNeoHookean;
  return material;
}

Pair cubesOf(int nodes_per_edge) {
  Pair out{cubeOf(nodes_per_edge, lawMaterial()), cubeOf(nodes_per_edge)};
  out.law.name = "cube, full cells";
  return out;
}

/// Returns two hearts. That of the law fills its surface, so most of its cells are partially filled.
Pair heartsOf(int nodes) {
  return {heartOf(nodes, lawMaterial()), heartOf(nodes)};
}

std::vector<Pair> pairsOf(bool short_form) {
  if (short_form) return {cubesOf(12), heartsOf(2000)};
  return {cubesOf(35), heartsOf(13000), heartsOf(42745)};
}

/// Returns the share of partially filled cells.
double partialShare(const Model& model) {
  const Lattice& lattice = model.bodies[0].lattice;
  size_t cells = 0;
  for (const uint8_t label : lattice.cell_labels) cells += label != 0 ? 1 : 0;
  return static_cast<double>(lattice.fills.size()) / static_cast<double>(cells);
}

}  // namespace

void measureCells(Report& report) {
  Table table("the neo-Hookean law, and springs in as many nodes", {{"body"},
                                                                    {"nodes", "", 8},
                                                                    {"cells in part", "", 2},
                                                                    {"backend"},
                                                                    {"law", "ns/update"},
                                                                    {"springs", "ns/update"},
                                                                    {"law over springs", "", 3},
                                                                    {"spread", "", 2}});
  // Rounds are short and many, so that other load of the machine affects both of a pair alike.
  const std::vector<std::pair<std::string, std::function<std::shared_ptr<TissueStepper>(const Specimen&)>>> variants = {
      {"cpu, 1 thread", [](const Specimen& specimen) { return onCpu(specimen, 1); }},
      {"cpu, all threads", [](const Specimen& specimen) { return onCpu(specimen); }},
      {"gpu", onGpu}};
  for (const Pair& pair : pairsOf(report.isShort())) {
    const size_t nodes = pair.law.nodes();
    report.stage("cells of a " + pair.law.name + " of " + std::to_string(nodes) + " nodes");
    for (const auto& [variant, on] : variants) {
      const std::vector<Rate> rates =
          measureRates({candidate("", on(pair.law), nodes), candidate("", on(pair.springs), pair.springs.nodes())},
                       report.isShort() ? 0.01 : 0.03, report.isShort() ? 5 : 25);
      const Rate &law = rates[0], &springs = rates[1];
      const double ratio = law.ns_per_update() / springs.ns_per_update();
      table.add({pair.law.name, static_cast<double>(nodes), partialShare(pair.law.model), variant, law.ns_per_update(),
                 springs.ns_per_update(), ratio, std::max(law.spread, springs.spread)});
      if (variant == "gpu") continue;
      report.checkAtMost("law: a substep over one of springs, per node, " + pair.law.name + " of " +
                             std::to_string(nodes) + ", " + variant,
                         ratio, kDearer);
    }
  }
  report.add(table, "cells");
}

}  // namespace viscera::bench
