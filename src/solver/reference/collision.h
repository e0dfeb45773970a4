// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/contact/collision.h"
#include "viscera/solver/state.h"

namespace viscera {

struct Scene;

/// Two nodes that touch, or nearly.
struct ReferencePair {
  CollisionPair slots;  ///< a < b
  double depth_m;       ///< D_ij minus their distance (collision.h) [m]; negative where they are near without touching
};

/// Returns all pairs of nodes that may touch (touchDepths(), or severed; not isolated) and are no farther apart than
/// D_ij + margin. Compares every pair, in float64. Ascending.
std::vector<ReferencePair> referencePairs(const Model& model, const Scene& scene, const HostState& state,
                                          double margin_m = 0);

/// Quality of a search. @param tolerance_m  pairs with a depth within it may be found or not
struct Recall {
  size_t there = 0, found = 0;  ///< pairs deeper than the tolerance, and how many of them were found
  size_t wrong = 0;             ///< pairs that were found and do not touch, or were found twice
  double share() const { return there > 0 ? static_cast<double>(found) / static_cast<double>(there) : 1; }
};
Recall recallOf(const std::vector<CollisionPair>& found, const std::vector<ReferencePair>& truth, double tolerance_m);

}  // namespace viscera
