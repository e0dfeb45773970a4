// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <random>

#include "bench/harness/rate.h"
#include "bench/suites/pace/cut_parts.h"
#include "bench/suites/pace/performance_suites.h"

namespace viscera::bench {

namespace {

constexpr unsigned kSeed = 11;
constexpr double kDearest = 1.25;  // cost of a node of a cut body relative to an uncut one

/// Removes a random share of the springs from a state, at both ends.
void cutAtRandom(const Lattice& lattice, double share, std::vector<layout::NodeBits>& nodes) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> draw(0, 1);
  for (uint32_t slot : lattice.active_slots) {
    for (uint32_t spring = 0; spring < layout::kSpringsPerNode; spring += 2) {
      if (springCount(nodes[slot], spring) == 0 || draw(random) >= share) continue;
      cutSpring(lattice, slot, spring, nodes);
    }
  }
}

/// One backend with all shares, one after the other, on one solver.
struct Runner {
  std::string name;
  std::shared_ptr<TissueStepper> solver;
  std::vector<double> rates;  ///< [shares] substeps/s
};

void measureShares(Report& report, const Specimen& specimen, const std::vector<double>& shares,
                   std::vector<Runner>& runners) {
  for (double share : shares) {
    report.stage(specimen.name + ", " + Cell(100 * share).text(3) + " % of springs cut");
    HostState state = specimen.start;
    cutAtRandom(specimen.model.bodies[0].lattice, share, state.nodes);
    std::vector<Candidate> candidates;
    for (const Runner& runner : runners) {
      runner.solver->writeState(state);
      candidates.push_back(candidate(runner.name, runner.solver, specimen.nodes()));
    }
    const std::vector<Rate> rates = measureRates(candidates, report.isShort() ? 0.02 : 0.2);
    for (size_t r = 0; r < runners.size(); ++r) runners[r].rates.push_back(rates[r].substeps_per_s);
  }
}

void addCurve(Plot& plot, const Specimen& specimen, const std::vector<double>& shares, const Runner& runner) {
  Series series{specimen.name + ", " + runner.name, {}, {}};
  for (size_t i = 0; i < shares.size(); ++i) {
    series.x.push_back(100 * shares[i]);
    series.y.push_back(runner.rates[i] / runner.rates[0]);
  }
  plot.series.push_back(series);
}

}  // namespace

void cutSuite(Report& report, gpu::Context& context) {
  measureIncision(report, context);
  const double size = report.isShort() ? 5000 : 42745;
  const std::vector<double> shares =
      report.isShort() ? std::vector<double>{0, 0.1, 1} : std::vector<double>{0, 0.001, 0.01, 0.1, 0.25, 0.5, 0.75, 1};
  Table table(
      "rate by share of springs cut, no dashpot",
      {{"body"}, {"nodes", "", 8}, {"backend"}, {"springs cut", "%"}, {"rate", "substeps/s"}, {"over whole", "", 3}});
  Plot plot{"Rate by share of springs cut", "springs cut [%]", "rate over that of the whole body", false, false, {}};
  double dearest = 0;
  for (const Specimen& specimen : {cubeOf(edgeOf(size)), heartOf(static_cast<int>(size))}) {
    std::vector<Runner> runners = {{"cpu", onCpu(specimen), {}}, {"gpu", onGpu(specimen), {}}};
    measureShares(report, specimen, shares, runners);
    for (const Runner& runner : runners) {
      for (size_t i = 0; i < shares.size(); ++i) {
        table.add({specimen.name, static_cast<double>(specimen.nodes()), runner.name, 100 * shares[i], runner.rates[i],
                   runner.rates[i] / runner.rates[0]});
        if (runner.name == "cpu") dearest = std::max(dearest, runner.rates[0] / runner.rates[i]);
      }
      addCurve(plot, specimen, shares, runner);
    }
  }
  report.add(table, "shares");
  report.add(plot, "shares");
  report.checkAtMost("cut over whole body, cost at the most expensive share, cpu", dearest, kDearest);
}

}  // namespace viscera::bench
