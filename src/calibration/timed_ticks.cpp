// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibration/timed_ticks.h"

#include <algorithm>
#include <chrono>

#include "viscera/solver/material.h"

namespace viscera {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

void fitTick(SolverConfig& solver, const Model& model, int substeps) {
  solver.measured_limit = false;
  solver.tick_hz = 1 / (substeps * solver.dt_fraction * safeTimeStep(model)) * (1 + 1e-9);
}

double stepAndWait(Solver& solver, const ToolMotions& motions) {
  const uint64_t before = solver.substepsDone();
  layout::TickStats stats;
  solver.step(motions);
  while (solver.pollStats(stats, true)) {
  }
  return static_cast<double>(solver.substepsDone() - before);
}

std::vector<double> substepTimes(Solver& solver, const std::function<ToolMotions()>& motions, const TimedTicks& ticks) {
  std::vector<double> seconds;
  const Clock::time_point begun = Clock::now();
  for (int t = -kWarmUpTicks; t < ticks.most; ++t) {
    const ToolMotions next = motions();
    const Clock::time_point start = Clock::now();
    const double substeps = stepAndWait(solver, next);
    if (t < 0) continue;
    seconds.push_back(secondsSince(start) / substeps);
    if (t + 1 >= ticks.least && secondsSince(begun) > ticks.watch_s) break;
  }
  return seconds;
}

double percentile(std::vector<double> values, double share) {
  const size_t at = std::min(values.size() - 1, static_cast<size_t>(share * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

double median(std::vector<double> values) {
  return percentile(std::move(values), 0.5);
}

}  // namespace viscera
