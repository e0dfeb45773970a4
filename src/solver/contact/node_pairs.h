// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

namespace viscera {

struct Scene;

// Contacts between nodes in the solution of an implicit substep (shaders/solver/implicit/implicit_pairs.glsl), on any
// backend.

/// Returns whether contacts between nodes are part of the solution of a substep.
bool solvesContacts(const Scene& scene);

/// Largest distance, over D_ij, of two nodes at the first iterate that may touch in the substep. It exceeds 1 so that
/// resting contacts are found although the iterate does not bring the nodes nearer.
constexpr float kPairReach = 1.1f;
/// Distance, over D_ij, below which a pair is missed after an implicit substep, and contacts act: pairs of its solution
/// keep D_ij.
constexpr float kMissedReach = 0.999f;
/// Capacity in ends of pairs per node that may touch others: a resting node has one to four.
constexpr size_t kPairEndsPerNode = 16;
/// Rounds of correction of forces in each sweep.
constexpr int kPairRounds = 2;

inline size_t mostPairEnds(size_t active_nodes) {
  constexpr size_t kLeast = 1024;
  return std::max(kLeast, kPairEndsPerNode * active_nodes);
}

}  // namespace viscera
