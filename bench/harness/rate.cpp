// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/rate.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "solver/cpu/cpu_solver.h"
#include "solver/gpu/gpu_solver.h"

namespace viscera::bench {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Returns the number of ticks in a time. The first tick compiles and allocates, the second measures the duration.
int ticksIn(const std::function<double()>& tick, double seconds) {
  tick();
  const Clock::time_point start = Clock::now();
  tick();
  return std::max(1, static_cast<int>(std::ceil(seconds / secondsSince(start))));
}

/// Returns the time per substep [s].
double substepTime(const std::function<double()>& tick, int ticks) {
  double substeps = 0;
  const Clock::time_point start = Clock::now();
  for (int t = 0; t < ticks; ++t) substeps += tick();
  return secondsSince(start) / substeps;
}

Rate rateOf(const Candidate& candidate, const std::vector<double>& substep_s) {
  const double middle = median(substep_s);
  const auto [fastest, slowest] = std::minmax_element(substep_s.begin(), substep_s.end());
  Rate rate;
  rate.substeps_per_s = 1 / middle;
  rate.node_updates_per_s = candidate.nodes / middle;
  rate.fastest_s = *fastest;
  rate.spread = (*slowest - *fastest) / middle;
  return rate;
}

}  // namespace

std::vector<Rate> measureRates(const std::vector<Candidate>& candidates, double seconds, int rounds) {
  std::vector<int> ticks;
  for (const Candidate& c : candidates) ticks.push_back(ticksIn(c.tick, seconds));
  std::vector<std::vector<double>> substep_s(candidates.size());
  for (int round = 0; round < rounds; ++round) {
    for (size_t c = 0; c < candidates.size(); ++c) substep_s[c].push_back(substepTime(candidates[c].tick, ticks[c]));
  }
  std::vector<Rate> rates;
  for (size_t c = 0; c < candidates.size(); ++c) rates.push_back(rateOf(candidates[c], substep_s[c]));
  return rates;
}

Candidate candidate(const std::string& name, std::shared_ptr<Solver> solver, size_t nodes, const ToolMotions& motions) {
  return {name, static_cast<double>(nodes),
          [solver = std::move(solver), motions] { return stepAndWait(*solver, motions); }};
}

std::shared_ptr<TissueStepper> onCpu(const Specimen& specimen, int threads, const std::string& simd) {
  Scene scene = specimen.scene;
  scene.solver.threads = threads;
  CpuSolverOptions options;
  options.simd = simd;
  auto solver = std::make_shared<CpuSolver>(specimen.model, scene, options);
  solver->writeState(specimen.start);
  return solver;
}

std::shared_ptr<TissueStepper> onGpu(const Specimen& specimen) {
  auto solver = std::make_shared<GpuSolver>(specimen.model, specimen.scene);
  solver->writeState(specimen.start);
  return solver;
}

}  // namespace viscera::bench
