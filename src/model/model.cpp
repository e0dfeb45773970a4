// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/model.h"

#include <algorithm>
#include <numeric>

namespace viscera {
namespace {

template <typename Count>
size_t sumOver(const std::vector<Body>& bodies, Count count) {
  return std::accumulate(bodies.begin(), bodies.end(), size_t{0},
                         [&](size_t sum, const Body& body) { return sum + count(body); });
}

}  // namespace

uint32_t Model::slotOffset(size_t body) const {
  size_t bricks = 0;
  for (size_t b = 0; b < body; ++b) bricks += bodies.at(b).lattice.bricks.size();
  return static_cast<uint32_t>(bricks * layout::kBrickSlots);
}

size_t Model::slots() const {
  return sumOver(bodies, [](const Body& body) { return body.lattice.bricks.size() * layout::kBrickSlots; });
}

size_t Model::activeNodes() const {
  return sumOver(bodies, [](const Body& body) { return body.lattice.active_slots.size(); });
}

size_t Model::springs() const {
  return sumOver(bodies,
                 [](const Body& body) { return body.network ? body.network->springs.size() : body.lattice.springs(); });
}

size_t Model::skinVertices() const {
  return sumOver(bodies, [](const Body& body) { return body.skin.mesh.positions_m.size(); });
}

size_t Model::skinTriangles() const {
  return sumOver(bodies, [](const Body& body) { return body.skin.mesh.triangles.size(); });
}

bool Model::hasNetwork() const {
  return std::any_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.network.has_value(); });
}

bool Model::hasLattice() const {
  return std::any_of(bodies.begin(), bodies.end(), [](const Body& body) { return !body.network.has_value(); });
}

Vector3d restPosition(const Body& body, uint32_t slot) {
  return body.network ? body.network->positions_m[slot] : body.lattice.restPosition(slot);
}

}  // namespace viscera
