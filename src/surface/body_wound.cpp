// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/body_wound.h"

#include "surface/keep_room.h"
#include "surface/wound_binding.h"

namespace viscera {

namespace {

constexpr double kBesideOwn = 0.15;  // cells: a lip so near a vertex of the skin hangs on the same nodes

}  // namespace

BodyWound::BodyWound(const Skin& skin, const Lattice& lattice)
    : cells_(lattice), own_bindings_(skin.bindings), bindings_(skin.bindings), skin_(skin, lattice) {
  is_rebound_.resize(own_bindings_.size());
}

void BodyWound::update(const layout::NodeBits* nodes, const float* axial_cut) {
  for (const uint32_t vertex : rebound_) {
    bindings_[vertex] = own_bindings_[vertex];
    is_rebound_[vertex] = false;
  }
  rebound_.clear();
  bindings_.resize(own_bindings_.size());
  cells_.update(nodes, axial_cut);
  skin_.update(cells_);
  walls_.update(cells_, skin_);
  const auto bind = [&](const WoundVertex& vertex) {
    return bindToSide(cells_, vertex.point, vertex.normal, vertex.place);
  };
  for (const auto& [vertex, how] : skin_.rebound()) {
    bindings_[vertex] = bind(how);
    is_rebound_[vertex] = true;
    rebound_.push_back(vertex);
  }
  for (const WoundVertex& vertex : skin_.added()) {
    if (skin_.isEnd(static_cast<uint32_t>(bindings_.size()))) {
      bindings_.push_back(bindAcross(cells_, vertex.point, vertex.normal, vertex.place));
      continue;
    }
    const uint32_t own = vertex.skin_vertex;
    const bool beside = is_rebound_[own] && (vertex.point - skin_.pointOf(own)).squaredNorm() < kBesideOwn * kBesideOwn;
    bindings_.push_back(beside ? bindLike(bindings_[own], cells_, vertex.point, vertex.normal) : bind(vertex));
  }
  for (const WoundVertex& vertex : walls_.vertices()) {
    if (vertex.skin_vertex == WoundVertex::kNone) {
      bindings_.push_back(bind(vertex));
    } else {
      bindings_.push_back(bindings_[vertex.skin_vertex]);
      setNormal(vertex.normal, bindings_.back());
    }
  }
  keepRoom(wall_triangles_, walls_.triangles().size());
  wall_triangles_ = walls_.triangles();
  for (uint32_t& vertex : wall_triangles_) vertex += static_cast<uint32_t>(firstWallVertex());
}

}  // namespace viscera
