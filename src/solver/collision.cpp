// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/collision.h"

#include <algorithm>

namespace viscera {

namespace {

/// A cell is larger than the reach by this factor: quotients of coordinates and cell are rounded.
constexpr double kCellMargin = 1.01;

uint32_t powerOf2(size_t least) {
  uint32_t out = 1;
  while (out < least) out *= 2;
  return out;
}

/// [slots] cells around each node of a lattice.
std::vector<uint8_t> cellsAround(const Lattice& lattice) {
  std::vector<uint8_t> out(lattice.nodes.size());
  for (const uint32_t lowest : lattice.active_slots) {
    if (!(lattice.nodes[lowest].lo & layout::kCellBit)) continue;
    forEachCorner(lattice, lowest, [&out](const Vector3i&, uint32_t slot) { ++out[slot]; });
  }
  return out;
}

bool isLattice(const Body& body) {
  return !body.network || body.network->of_lattice;
}

}  // namespace

double collisionDistance(const Body& body, const CollisionConfig& config) {
  if (config.distance_m > 0) return config.distance_m;
  return isLattice(body) ? body.lattice.spacing_m : body.network->meanLength();
}

double collisionReach(const Model& model, const CollisionConfig& config) {
  double reach = 0;
  for (const Body& body : model.bodies) reach = std::max(reach, collisionDistance(body, config));
  return reach;
}

double collisionCell(const Model& model, const CollisionConfig& config) {
  return (config.search == CollisionSearch::kGrid ? kCellMargin : 2.0) * collisionReach(model, config);
}

std::vector<uint32_t> collidableNodes(const Model& model) {
  constexpr uint8_t kInside = 8;
  constexpr uint32_t kWordBits = 32;
  std::vector<uint32_t> out(model.slots() / kWordBits + 1);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const std::vector<uint8_t> cells = isLattice(body) ? cellsAround(body.lattice) : std::vector<uint8_t>{};
    for (const uint32_t slot : body.lattice.active_slots) {
      if (!cells.empty() && cells[slot] == kInside) continue;
      const uint32_t at = model.slotOffset(b) + slot;
      out[at / kWordBits] |= 1u << at % kWordBits;
    }
  }
  return out;
}

uint32_t bucketCount(size_t nodes) {
  return powerOf2(2 * nodes);
}

uint32_t sortedCount(size_t nodes) {
  return powerOf2(std::max<size_t>(nodes, 2));
}

}  // namespace viscera
