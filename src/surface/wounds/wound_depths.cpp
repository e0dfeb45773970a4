// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wounds/wound_depths.h"

#include <algorithm>

#include "model/shape/mesh/triangle_tree.h"

namespace viscera {

WoundDepths::WoundDepths(const Skin& skin, const Lattice& lattice)
    : lattice_(lattice), depth_m_(lattice.nodes.size(), 0) {
  const TriangleTree tree(skin.mesh);
  for (const uint32_t slot : lattice.active_slots) {
    const Vector3f node = lattice.restPosition(slot).cast<float>();
    const MeshPoint nearest = tree.nearest(node);
    if (!nearest.found()) continue;
    const auto& c = skin.mesh.triangles[nearest.triangle];
    const Vector3f a = skin.mesh.positions_m[c[0]];
    const Vector3f front = (skin.mesh.positions_m[c[1]] - a).cross(skin.mesh.positions_m[c[2]] - a);
    depth_m_[slot] = front.dot(node - a) > 0 ? -nearest.distance_m : nearest.distance_m;
  }
}

double WoundDepths::at(const Vector3d& point) const {
  const Vector3i cell = point.array().floor().cast<int>();
  const Vector3d within = point - cell.cast<double>();
  double sum = 0, weights = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    Vector3i node = cell;
    for (int axis = 0; axis < 3; ++axis) {
      const int high = corner >> axis & 1;
      node[axis] += high;
      weight *= high ? within[axis] : 1 - within[axis];
    }
    const int64_t slot = lattice_.slotAt(node);
    if (slot < 0) continue;
    sum += weight * depth_m_[static_cast<size_t>(slot)];
    weights += weight;
  }
  return weights > 0 ? std::max(0.0, sum / weights) : 0;
}

}  // namespace viscera
