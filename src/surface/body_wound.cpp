// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/body_wound.h"

#include "surface/wound_binding.h"

namespace viscera {

void BodyWound::update(const layout::NodeBits* nodes, const float* axial_cut) {
  cells_.update(nodes, axial_cut);
  skin_.update(cells_);
  walls_.update(cells_, skin_);
  bindings_ = own_bindings_;
  const auto bind = [&](const WoundVertex& vertex) {
    return bindToSide(cells_, vertex.point, vertex.normal, vertex.place);
  };
  for (const auto& [vertex, how] : skin_.rebound()) bindings_[vertex] = bind(how);
  for (const WoundVertex& vertex : skin_.added()) bindings_.push_back(bind(vertex));
  for (const WoundVertex& vertex : walls_.vertices()) {
    if (vertex.skin_vertex == WoundVertex::kNone) {
      bindings_.push_back(bind(vertex));
    } else {
      bindings_.push_back(bindings_[vertex.skin_vertex]);
      setNormal(vertex.normal, bindings_.back());
    }
  }
  wall_triangles_ = walls_.triangles();
  for (uint32_t& vertex : wall_triangles_) vertex += static_cast<uint32_t>(firstWallVertex());
}

}  // namespace viscera
