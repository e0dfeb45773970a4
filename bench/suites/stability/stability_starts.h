// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bench/harness/specimens/block.h"

namespace viscera::bench {

constexpr const char* kCollapsed = "collapsed to a point";  ///< the start in which forces have no direction

/// A state that no session should ever reach.
struct Start {
  std::string name;
  HostState state;
};

/// Returns eight starts of a model of one body: random nodes in the body's box, all in its centre, flattened onto a
/// plane, mirrored, ten times as long along one axis, ten times as large, moving at up to ten times c_p, swapped.
std::vector<Start> extremeStarts(const Model& model);

/// Returns elastic plus kinetic energy in float64 [J] of a state with velocities that are `lag_s` behind its
/// displacements.
double energyOf(ReferenceSolver& reference, const HostState& state, double lag_s);

}  // namespace viscera::bench
