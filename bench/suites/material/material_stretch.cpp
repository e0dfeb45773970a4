// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "bench/harness/specimens/block.h"
#include "bench/suites/material/material_parts.h"
#include "solver/reference/statics.h"

namespace viscera::bench {

namespace {

/// physics.md 6, oracle 5: k = h = 1.
struct Stretch {
  double axial, lateral, stress;
};
constexpr Stretch kMaterialStretchTable[] = {{0.9, 1.02509614, -0.23220140}, {1.01, 0.99750205, 0.02517550},
                                             {1.1, 0.97528475, 0.26725437},  {1.5, 0.88822938, 1.63251783},
                                             {2, 0.81303026, 3.75959822},    {10, 0.63589939, 43.35454844}};
constexpr double kMaterialStretchLimit = 1e-4;  ///< issue 3: relative
constexpr int kWidth = 2, kLength = 3;

std::vector<PrescribedDof> stretched(const Lattice& lattice, double axial) {
  std::vector<PrescribedDof> out;
  for (uint32_t slot : lattice.active_slots) {
    const int z = lattice.nodeAt(slot).z();
    if (z == 0 || z == kLength) out.push_back({slot, 2, z * (axial - 1)});
  }
  const auto slotOf = [&](int x) { return static_cast<uint32_t>(lattice.slotAt({x, 0, 0})); };
  out.insert(out.end(), {{slotOf(0), 0, 0}, {slotOf(0), 1, 0}, {slotOf(kWidth), 1, 0}});
  return out;
}

/// Returns the force on the face z = 0 over its area at rest [k/h]. @param force_n  [slots]
double stressOf(const Lattice& lattice, const Field& force_n) {
  double sum = 0;
  for (uint32_t slot : lattice.active_slots) {
    if (lattice.nodeAt(slot).z() == 0) sum += force_n[slot].z();
  }
  return sum / (kWidth * kWidth);
}

}  // namespace

void measureFiniteStretch(Report& report) {
  report.stage("finite stretch");
  std::vector<Column> columns = {
      {"stretch"}, {"lateral", "", 9}, {"stress", "k/h", 9}, {"lateral error"}, {"stress error"}};
  for (Backend backend : report.backends()) columns.push_back({nameOf(backend) + ": stress error"});
  Table table("Finite uniaxial stretch of a block with free sides, nu 1/4, k = h = 1; errors relative", columns);
  Series found{"float64 statics", {}, {}}, exact{"exact", {}, {}, Series::Style::kPoints};
  double worst = 0;
  std::vector<double> worst_on(report.backends().size());
  const Model model = blockModel({kWidth, kWidth, kLength}, 1, unitMaterial());
  const Lattice& lattice = model.bodies[0].lattice;
  for (const Stretch& row : kMaterialStretchTable) {
    ReferenceSolver solver(model, Vector3d::Zero(), 1);
    StaticsOptions options;
    options.load_steps = 1 + static_cast<int>(4 * std::abs(row.axial - 1));
    solveStatics(solver, stretched(lattice, row.axial), {}, options);
    const uint32_t far = static_cast<uint32_t>(lattice.slotAt({kWidth, 0, 1}));
    const uint32_t near = static_cast<uint32_t>(lattice.slotAt({0, 0, 1}));
    const double lateral = 1 + (solver.u_m[far].x() - solver.u_m[near].x()) / kWidth;
    const double stress = stressOf(lattice, solver.elasticForces(solver.u_m));
    std::vector<Cell> cells = {row.axial, lateral, stress, lateral / row.lateral - 1, stress / row.stress - 1};
    for (size_t b = 0; b < worst_on.size(); ++b) {
      const double on = stressOf(lattice, forcesOn(report.backends()[b], model, solver.u_m)) / row.stress - 1;
      cells.emplace_back(on);
      worst_on[b] = std::max(worst_on[b], std::abs(on));
    }
    table.add(cells);
    worst = std::max({worst, std::abs(lateral / row.lateral - 1), std::abs(stress / row.stress - 1)});
    found.x.push_back(row.axial);
    found.y.push_back(stress);
  }
  for (const Stretch& row : kMaterialStretchTable) {
    exact.x.push_back(row.axial);
    exact.y.push_back(row.stress);
  }
  report.add(table, "stretch");
  report.add(Plot{"Finite uniaxial stretch", "stretch", "nominal stress [k/h]", false, false, {found, exact}},
             "stretch");
  report.checkAtMost("finite stretch: largest relative error of lateral stretch and stress", worst,
                     kMaterialStretchLimit);
  for (size_t b = 0; b < worst_on.size(); ++b) {
    report.checkAtMost(
        "finite stretch, forces of " + nameOf(report.backends()[b]) + ": largest relative error of stress", worst_on[b],
        kMaterialStretchLimit);
  }
}

}  // namespace viscera::bench
