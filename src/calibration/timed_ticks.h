// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "viscera/model/model.h"
#include "viscera/model/scene/solver_config.h"
#include "viscera/solver/solver.h"

namespace viscera {

/// Sets the tick to the length of so many substeps of the proven limit.
void fitTick(SolverConfig& solver, const Model& model, int substeps);

/// Makes a tick and waits until its measurements are on the host. @return substeps done
double stepAndWait(Solver& solver, const ToolMotions& motions);

constexpr int kWarmUpTicks = 2;  ///< not timed: the first compiles and allocates

/// How many ticks are timed: until `least` of them and `watch_s` seconds are reached, `most` at most.
struct TimedTicks {
  int least, most;
  double watch_s;
};
/// Returns the clock time per substep of every timed tick [s]. @param motions  of the next tick
std::vector<double> substepTimes(Solver& solver, const std::function<ToolMotions()>& motions, const TimedTicks& ticks);

/// Returns the middle value, the upper of two. @param values  not empty
double median(std::vector<double> values);
/// Returns the value below which a share of the values is. @param values  not empty   @param share  0..1
double percentile(std::vector<double> values, double share);

}  // namespace viscera
