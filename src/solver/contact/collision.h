// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/model/model.h"
#include "viscera/model/scene/environment_config.h"

namespace viscera {

// Contacts between nodes, of one body or of two (GW 5; physics.md 8). Two nodes touch where they are nearer than
//   D_ij = max(D_a, D_b)                                  nodes of bodies a and b
//   D_ij = min(the same, half of their distance at rest)  nodes of one body, so that nothing repels at rest
// with D = collision.distance_m, or the mean length of a body's springs where that is 0.
// Where cells are tissue in part, surfaces touch and not nodes: those that may touch lie within the tissue, less than a
// cell deep, which is one of any row of nodes that goes through the surface, and D_ij is longer by how deep the two
// lie. So forces stay on the nodes between which the distance is, and are those of an energy. (A point of the surface
// that a node and its neighbours carry along would not do: what pushes that node alone may move the point the other
// way.)
//
// What passes through what: a sheet whose nodes are no farther apart than D has no hole that a node could slip through
// within one substep as long as the two move less than D/2 relative to each other in it. The cell of the
// search is the largest D, so that is half a cell. Contact is found at the end of the substep and undoes the approach
// that led to it, so nodes come no nearer than where they were before; they are then pushed apart to D slowly, which
// makes no velocity.

/// Slots a < b of two nodes that touch.
using CollisionPair = std::array<uint32_t, 2>;

/// Mean length of a body's springs [m]: of a lattice its spacing.
double collisionDistance(const Body& body, const CollisionConfig& config);
/// Largest distance of two nodes that touch [m].
double collisionReach(const Model& model, const CollisionConfig& config);
/// Edge of a cell of the search [m].
double collisionCell(const Model& model, const CollisionConfig& config);

/// [slots] how deep the nodes lie that may touch others [m], or kTouchesOnceCut, or kNeverTouches
/// (shaders/layout/touch_depths.h). All of a network may, and those on the outside of a lattice, with depth 0; where
/// cells are tissue in part, those less than a cell below the surface, and outside of it where these leave it bare.
std::vector<float> touchDepths(const Model& model, const CollisionConfig& config);

/// Nodes of a bucket of the search's hashed grid that may be compared each with all: ten times as many as lie
/// in the reach of the coarsest of two bodies whose spacings differ tenfold. Larger crowds have collapsed into one
/// place: nodes in one touch nothing until it has spread, and are counted (TickStats::crowded), on any backend.
constexpr uint32_t kMostInBucket = 4096;
/// Buckets of the hashed grid: the power of 2 that is at least twice the nodes.
uint32_t bucketCount(size_t nodes);

}  // namespace viscera
