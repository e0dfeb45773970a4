// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "bench/harness/specimens/block.h"
#include "bench/suites/material/material_parts.h"
#include "solver/reference/statics.h"

namespace viscera::bench {

namespace {

/// physics.md 6, oracle 7: tip deflection over Timoshenko's, at nu = 1/4.
struct Known {
  int depth;  ///< [cells]
  double ratio;
};
constexpr Known kTable[] = {{1, 0.528}, {2, 0.794}, {3, 0.889}, {4, 0.929}, {6, 0.962}, {8, 0.974}};
constexpr double kLimit = 0.005;  ///< issue 3: relative
constexpr int kSlenderness = 5;   ///< length over depth
constexpr int kShortDepth = 4;

/// Returns the deflection of the tip under unit load, relative to Timoshenko's beam with the same E, nu, depth and
/// length.
double tipRatio(int depth, const MaterialConfig& material) {
  const int length = kSlenderness * depth;
  const Model model = blockModel({length, depth, depth}, 1, material, [](const Vector3i& n) { return n.x() == 0; });
  const Lattice& lattice = model.bodies[0].lattice;
  const ReferenceSolver solver(model, Vector3d::Zero(), 1);
  Field load(model.slots(), Vector3d::Zero());
  std::vector<uint32_t> tip;
  double eighths = 0;
  for (uint32_t slot : lattice.active_slots) {
    if (lattice.nodeAt(slot).x() != length) continue;
    tip.push_back(slot);
    eighths += massEighths(lattice.nodes[slot]);
  }
  // The load is uniform over the end face: every node has its share of the face.
  for (uint32_t slot : tip) load[slot].z() = massEighths(lattice.nodes[slot]) / eighths;
  const Field u = solveLinear(solver, {}, load);
  double deflection = 0;
  for (uint32_t slot : tip) deflection += u[slot].z() / static_cast<double>(tip.size());

  const double nu = material.poisson_ratio, young = material.young_modulus_pa, l = length, d = depth;
  const double kappa = 10 * (1 + nu) / (12 + 11 * nu), shear = young / (2 * (1 + nu));
  return deflection / (l * l * l / (3 * young * d * d * d * d / 12) + l / (kappa * shear * d * d));
}

}  // namespace

void measureCantilever(Report& report) {
  Table table("Cantilever of springs, n cells deep, 5 n long, load on its tip: deflection over Timoshenko's",
              {{"n"}, {"table", "", 3}, {"springs", "", 5}, {"over table - 1"}});
  Series measured{"springs", {}, {}}, known{"table", {}, {}, Series::Style::kPoints};
  double worst = 0;
  for (const Known& row : kTable) {
    if (report.isShort() && row.depth > kShortDepth) break;
    report.stage("cantilever, n " + std::to_string(row.depth));
    const double ratio = tipRatio(row.depth, unitMaterial());
    table.add({row.depth, row.ratio, ratio, ratio / row.ratio - 1});
    worst = std::max(worst, std::abs(ratio / row.ratio - 1));
    measured.x.push_back(row.depth), measured.y.push_back(1 - ratio);
    known.x.push_back(row.depth), known.y.push_back(1 - row.ratio);
  }
  report.add(table, "cantilever");
  report.add(Plot{"Cantilever: 1 - deflection / Timoshenko's",
                  "cells across the depth",
                  "too stiff by",
                  true,
                  true,
                  {measured, known}},
             "cantilever");
  report.checkAtMost("cantilever: largest relative distance from the table", worst, kLimit);
}

}  // namespace viscera::bench
