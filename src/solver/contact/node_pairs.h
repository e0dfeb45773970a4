// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

namespace viscera {

struct Scene;

// Contacts between nodes in the solution of an implicit substep (shaders/solver/implicit/implicit_pairs.glsl), any
// backend.

/// Are contacts between nodes part of the solution of a substep?
bool solvesContacts(const Scene& scene);

/// Of D_ij: how near two nodes are, where the first iterate leads, that may touch in the substep. What lies on
/// something is found though the iterate does not bring it nearer.
constexpr float kPairReach = 1.1f;
/// Of D_ij: how near two nodes are after an implicit substep that contacts act on: its solution's keep D_ij.
constexpr float kMissedReach = 0.999f;
/// Ends of pairs for which there is room, per node that may touch others: what lies on something has one to four.
constexpr size_t kPairEndsPerNode = 16;
/// Rounds in which forces are mended in each sweep.
constexpr int kPairRounds = 2;

inline size_t mostPairEnds(size_t active_nodes) {
  constexpr size_t kLeast = 1024;
  return std::max(kLeast, kPairEndsPerNode * active_nodes);
}

}  // namespace viscera
