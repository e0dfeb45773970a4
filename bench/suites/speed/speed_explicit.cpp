// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include "bench/harness/rate.h"
#include "bench/suites/speed/speed_parts.h"
#include "model/body/network_builder.h"

namespace viscera::bench {

namespace {

constexpr double kShare = 0.5;  // relative to the implicit rate, on the GPU, at 10,000 to 100,000 nodes (issue 5)

/// VR05 Table 1: iterations per second of its implicit and its explicit GPU method.
struct Printed {
  double nodes, implicit_rate, explicit_rate;
};
constexpr Printed kPaper[] = {
    {10000, 839.8, 457.1}, {20000, 476.9, 234.4}, {40000, 264.6, 121.0}, {50000, 218.0, 99.0}, {100000, 104.1, 48.5}};

/// Returns the same body with every spring of its lattice as links of both ends (VR05 2.5.1).
Specimen withLinks(Specimen specimen) {
  Body& body = specimen.model.bodies[0];
  body.network = latticeNetwork(body);
  specimen.start.spring_cut.assign(body.network->springs.size(), 0);
  return specimen;
}

enum Variant { kImplicitGpu, kExplicitGpu, kImplicitCpu, kExplicitCpu };
const char* const kConnections[] = {"implicit", "explicit"};

std::vector<Rate> ratesOf(const Specimen& specimen, double seconds) {
  const Specimen links = withLinks(specimen);
  std::vector<Candidate> candidates;
  for (const Specimen* s : {&specimen, &links}) candidates.push_back(candidate("gpu", onGpu(*s), s->nodes()));
  for (const Specimen* s : {&specimen, &links}) candidates.push_back(candidate("cpu", onCpu(*s), s->nodes()));
  return measureRates(candidates, seconds);
}

Table explicitTable() {
  return Table("explicit connections of the same lattice compared with implicit ones (VR05 Table 1, on its GPU)",
               {{"body"},
                {"nodes", "", 8},
                {"dashpot"},
                {"backend"},
                {"connections"},
                {"rate", "substeps/s"},
                {"updates", "M node updates/s"},
                {"over implicit", "", 3},
                {"spread", "", 2},
                {"VR05", "iterations/s"},
                {"VR05 over implicit", "", 3}});
}

void addRows(Table& table, const Specimen& specimen, double dashpot, const std::vector<Rate>& rates,
             const Printed& paper) {
  for (size_t variant = 0; variant < rates.size(); ++variant) {
    const bool gpu = variant < kImplicitCpu, implicit = variant == kImplicitGpu || variant == kImplicitCpu;
    const Rate& base = rates[gpu ? kImplicitGpu : kImplicitCpu];
    const double printed = implicit ? paper.implicit_rate : paper.explicit_rate;
    table.add({specimen.name, static_cast<double>(specimen.nodes()), dashpot, gpu ? "gpu" : "cpu",
               kConnections[variant % 2], rates[variant].substeps_per_s, rates[variant].node_updates_per_s * 1e-6,
               rates[variant].node_updates_per_s / base.node_updates_per_s, rates[variant].spread,
               gpu ? Cell(printed) : Cell(""), gpu ? Cell(printed / paper.implicit_rate) : Cell("")});
  }
}

}  // namespace

void measureExplicit(Report& report) {
  Table table = explicitTable();
  double least = std::numeric_limits<double>::infinity();
  for (const Printed& paper : kPaper) {
    if (report.isShort() && paper.nodes > kPaper[0].nodes) break;
    const auto nodes = static_cast<int>(paper.nodes);
    for (Specimen specimen : {cubeOf(edgeOf(nodes)), heartOf(nodes)}) {
      for (double dashpot : {0.0, 0.2}) {
        report.stage("explicit connections, " + specimen.name + " of " + std::to_string(specimen.nodes()) +
                     " nodes, dashpot " + Cell(dashpot).text(2));
        specimen.model.bodies[0].material.stiffness_damping_ratio = dashpot;
        const std::vector<Rate> rates = ratesOf(specimen, report.isShort() ? 0.02 : 0.1);
        addRows(table, specimen, dashpot, rates, paper);
        const double over_implicit = rates[kExplicitGpu].node_updates_per_s / rates[kImplicitGpu].node_updates_per_s;
        if (dashpot == 0) least = std::min(least, over_implicit);
      }
    }
  }
  report.add(table, "explicit");
  report.checkAtLeast("explicit over implicit rate, gpu, worst body without dashpot", least, kShare);
}

}  // namespace viscera::bench
