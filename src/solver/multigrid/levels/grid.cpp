// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/levels/grid.h"

namespace viscera::multigrid {

namespace {

size_t roundedUp(size_t count) {
  return (count + kBlock - 1) / kBlock * kBlock;
}

}  // namespace

Grid::Grid(const Model& model) {
  bodies.resize(model.bodies.size());
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (body.network) continue;
    const Vector3i count = body.lattice.nodes_per_axis;
    Box& box = bodies[b];
    box.row = count.x() + 1;  // one place that is empty: x - 1 of the next row
    box.layer = box.row * (count.y() + 1);
    const size_t margin = roundedUp(static_cast<size_t>(box.layer + box.row) + 1 + kBlock);
    const size_t first = roundedUp(places_) + margin;
    places_ = first + static_cast<size_t>(box.layer) * static_cast<size_t>(count.z()) + margin;
    for (const uint32_t slot : body.lattice.active_slots) {
      const Vector3i node = body.lattice.nodeAt(slot);
      slots.push_back(model.slotOffset(b) + slot);
      place_of.push_back(static_cast<uint32_t>(beside(static_cast<uint32_t>(b), first, node.x(), node.y(), node.z())));
      at.push_back(node);
      body_of_.push_back(static_cast<uint32_t>(b));
    }
  }
  places_ = roundedUp(places_);
  node_at.assign(places_, -1);
  std::vector<uint32_t> body_in(places_ / kBlock);
  std::vector<uint8_t> any(places_ / kBlock);
  for (uint32_t node = 0; node < nodeCount(); ++node) {
    node_at[place_of[node]] = static_cast<int32_t>(node);
    body_in[place_of[node] / kBlock] = body_of_[node];
    any[place_of[node] / kBlock] = 1;
  }
  for (size_t i = 0; i < any.size(); ++i) {
    if (any[i]) blocks.push_back({static_cast<uint32_t>(i * kBlock), body_in[i]});
  }
}

}  // namespace viscera::multigrid
