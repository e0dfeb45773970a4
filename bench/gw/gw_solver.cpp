// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "bench/gw/gw_parts.h"
#include "bench/harness/rate.h"

namespace viscera::bench {

namespace {

constexpr uint32_t kRegularValence = 6;  // of the regular sheet, its border aside

Specimen specimenOf(const GwNetwork& network, double dashpot, SpringForces forces) {
  Specimen out{network.name, network.model, {}, {}};
  out.model.bodies[0].material.dashpot_ratio = dashpot;
  out.scene = plainScene(out.model, kSpecimenSubsteps);
  out.scene.solver.sleep_speed_m_per_s = 0;
  out.scene.solver.spring_forces = forces;
  out.start = stateOf(out.model, deformed(network));
  out.start.spring_cut.assign(network.springs(), 0);
  return out;
}

/// GW 5: at varying valence the edge-centric way is the faster one.
void checkVaryingValence(Report& report, const GwNetwork& network, double dashpot, const Rate& point,
                         const Rate& edge) {
  if (valencesOf(network).most <= kRegularValence) return;
  report.checkAtLeast("solver, " + network.name + ", dashpot " + Cell(dashpot).text(2) +
                          ": edge-centric over point-centric rate, GPU backend",
                      edge.substeps_per_s / point.substeps_per_s, 1);
}

void addRow(Table& table, const Specimen& specimen, double dashpot, const Rate& point, const Rate& edge,
            const char* backend) {
  table.add({specimen.name, static_cast<double>(specimen.nodes()), dashpot, backend, point.substeps_per_s,
             edge.substeps_per_s, edge.substeps_per_s / point.substeps_per_s, std::max(point.spread, edge.spread)});
}

}  // namespace

void measureSolver(Report& report) {
  Table table(
      "The solver's own passes, forces and integration in one, 20 substeps and a measurement per tick "
      "(solver.spring_forces)",
      {{"mesh"},
       {"nodes", "", 8},
       {"dashpot"},
       {"backend"},
       {"point", "substeps/s"},
       {"edge", "substeps/s"},
       {"edge over point", "", 3},
       {"spread", "", 2}});
  const uint32_t edge_nodes = report.isShort() ? 128 : 256;
  for (const GwNetwork& network : {regularSheet(edge_nodes), irregularSheet(edge_nodes)}) {
    for (double dashpot : {0.0, 0.2}) {
      report.stage("solver, " + network.name + ", dashpot " + Cell(dashpot).text(2));
      const Specimen point = specimenOf(network, dashpot, SpringForces::kPoint);
      const Specimen edge = specimenOf(network, dashpot, SpringForces::kEdge);
      const size_t nodes = network.nodes();
      const std::vector<Rate> rates =
          measureRates({candidate("", onGpu(point), nodes), candidate("", onGpu(edge), nodes),
                        candidate("", onCpu(point), nodes), candidate("", onCpu(edge), nodes)},
                       report.isShort() ? 0.02 : 0.2);
      addRow(table, point, dashpot, rates[0], rates[1], "gpu");
      checkVaryingValence(report, network, dashpot, rates[0], rates[1]);
      addRow(table, point, dashpot, rates[2], rates[3], "cpu");
    }
  }
  report.add(table, "solver");
}

}  // namespace viscera::bench
