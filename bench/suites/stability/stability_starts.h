// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bench/harness/specimens/block.h"

namespace viscera::bench {

constexpr const char* kCollapsed = "collapsed to a point";  ///< the start in which no force has a direction

/// A state that no session should ever be in.
struct Start {
  std::string name;
  HostState state;
};

/// Eight starts of a model of one body: nodes anywhere in the body's box, all in its middle, flattened on a plane,
/// mirrored, ten times as long along one axis, ten times as large, moving at up to ten times c_p, swapped.
std::vector<Start> extremeStarts(const Model& model);

/// Elastic plus kinetic energy in float64 [J] of a state whose velocities are `lag_s` behind its displacements.
double energyOf(ReferenceSolver& reference, const HostState& state, double lag_s);

}  // namespace viscera::bench
