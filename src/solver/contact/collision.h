// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/model/model.h"
#include "viscera/model/scene/environment_config.h"

namespace viscera {

// Contacts between nodes, of one body or of two (GW 5; physics.md 8). Two nodes touch if they are nearer than
//   D_ij = max(D_a, D_b)                                  nodes of bodies a and b
//   D_ij = min(the same, half of their distance at rest)  nodes of one body, so that nothing repels at rest
// with D = collision.distance_m, or the mean length of a body's springs if that is 0.
// Where cells are partially filled, surfaces touch and not nodes. The nodes that may touch are within the tissue, less
// than a cell deep, so every row of nodes through the surface has one. D_ij grows by the depths of both nodes. So
// forces act on the nodes that define the distance, and derive from an energy. (A point of the surface that moves with
// a node and its neighbours would not do: a push on that node alone may move the point the opposite way.)
//
// What may pass through what: a sheet with nodes no farther apart than D has no hole for a node, as long as the two
// move less than D/2 relative to each other in a substep. The cell of the search is the largest D, so that is half a
// cell. Contact is found at the end of the substep and undoes the approach that led to it, so nodes come no nearer than
// they were before. They are then pushed apart to D slowly, which adds no velocity.

/// Slots a < b of two nodes that touch.
using CollisionPair = std::array<uint32_t, 2>;

/// Returns the mean length of a body's springs [m]: of a lattice its spacing.
double collisionDistance(const Body& body, const CollisionConfig& config);
/// Returns the largest distance of two nodes that touch [m].
double collisionReach(const Model& model, const CollisionConfig& config);
/// Returns the edge of a cell of the search [m].
double collisionCell(const Model& model, const CollisionConfig& config);

/// Returns [slots] depths of the nodes that may touch others [m], or kTouchesOnceCut, or kNeverTouches
/// (shaders/layout/touch_depths.h). All nodes of a network may touch, and those on the outside of a lattice, with depth
/// 0. Where cells are partially filled, nodes less than a cell below the surface may touch, and nodes outside it where
/// these leave it uncovered.
std::vector<float> touchDepths(const Model& model, const CollisionConfig& config);

/// Largest number of nodes in a bucket of the search's hashed grid that are compared pairwise: ten times the number
/// within the reach of the coarser of two bodies with spacings that differ tenfold. Larger crowds have collapsed into
/// one place. Their nodes touch nothing until they spread, and are counted (TickStats::crowded), on any backend.
constexpr uint32_t kMostInBucket = 4096;
/// Returns the number of buckets of the hashed grid: the smallest power of 2 that is at least twice the nodes.
uint32_t bucketCount(size_t nodes);

}  // namespace viscera
