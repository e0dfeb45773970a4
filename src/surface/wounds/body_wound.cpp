// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/wounds/body_wound.h"

#include <algorithm>

#include "surface/skins/keep_room.h"
#include "surface/wounds/wound_binding.h"

namespace viscera {

namespace {

constexpr double kBesideOwn = 0.15;  // cells: a lip this near a vertex of the surface mesh is bound to the same nodes

layout::SkinBinding bind(const CutCells& cells, const WoundVertex& vertex) {
  return bindToSide(cells, vertex.point, vertex.normal, vertex.position);
}

}  // namespace

BodyWound::BodyWound(const Skin& skin, const Lattice& lattice)
    : cells_(lattice), own_bindings_(skin.bindings), bindings_(skin.bindings), skin_(skin, lattice) {}

/// Binds the vertices of the surface mesh that its last update has checked.
void BodyWound::bindSkin() {
  for (const uint32_t vertex : skin_.lookedAt())
    bindings_[vertex] = skin_.isRebound(vertex) ? bind(cells_, skin_.own(vertex)) : own_bindings_[vertex];
  keepRoom(lip_bindings_, skin_.added().size());
  lip_bindings_.resize(skin_.added().size());
  for (const uint32_t i : skin_.lookedAtAdded()) {
    const WoundVertex& vertex = skin_.added()[i];
    const uint32_t own = vertex.skin_vertex;
    const bool beside =
        skin_.isRebound(own) && (vertex.point - skin_.pointOf(own)).squaredNorm() < kBesideOwn * kBesideOwn;
    if (skin_.isEnd(skin_.ownCount() + i)) {
      lip_bindings_[i] = bindAcross(cells_, vertex.point, vertex.normal, vertex.position);
    } else if (beside) {
      lip_bindings_[i] = bindLike(bindings_[own], cells_, vertex.point, vertex.normal);
    } else {
      lip_bindings_[i] = bind(cells_, vertex);
    }
  }
}

/// Binds the vertices of walls that have changed, and those that belong to a lip.
void BodyWound::bindWalls() {
  const std::vector<WoundVertex>& vertices = walls_.vertices();
  keepRoom(wall_bindings_, vertices.size());
  wall_bindings_.resize(vertices.size());
  const auto bind_one = [&](uint32_t i) {
    const WoundVertex& vertex = vertices[i];
    if (vertex.skin_vertex == WoundVertex::kNone) {
      wall_bindings_[i] = bind(cells_, vertex);
    } else {
      wall_bindings_[i] = lip_bindings_[vertex.skin_vertex - skin_.ownCount()];
      setNormal(vertex.normal, wall_bindings_[i]);
    }
  };
  for (const uint32_t i : walls_.changed()) bind_one(i);
  for (const uint32_t added : skin_.lookedAtAdded()) {
    const uint32_t along = walls_.alongLip(added);
    if (along != WoundMesh::kNone) bind_one(along);
  }
}

void BodyWound::update(const layout::NodeBits* nodes, const float* axial_cut) {
  cells_.update(nodes, axial_cut);
  follow();
}

void BodyWound::makeWhole() {
  cells_.makeWhole();
  follow();
}

void BodyWound::follow() {
  if (cells_.isWhole()) {
    for (const uint32_t vertex : skin_.rebound()) bindings_[vertex] = own_bindings_[vertex];
  }
  const size_t made = walls_.trianglesMade();
  skin_.update(cells_);
  walls_.update(cells_, skin_);
  bindSkin();
  bindWalls();
  work_ = {cells_.changedCells().size(), skin_.visitedCount(), walls_.trianglesMade() - made, walls_.pointsTried(),
           skin_.lookedAt().size() + skin_.lookedAtAdded().size() + walls_.changed().size()};
  // Copies; their cost grows with the wound. Added vertices follow the own ones, those of walls follow those of lips.
  const size_t own = own_bindings_.size(), first_wall = firstWallVertex();
  keepRoom(bindings_, first_wall + wall_bindings_.size());
  bindings_.resize(first_wall + wall_bindings_.size());
  std::copy(lip_bindings_.begin(), lip_bindings_.end(), bindings_.begin() + static_cast<ptrdiff_t>(own));
  std::copy(wall_bindings_.begin(), wall_bindings_.end(), bindings_.begin() + static_cast<ptrdiff_t>(first_wall));
  keepRoom(wall_triangles_, walls_.triangles().size());
  wall_triangles_ = walls_.triangles();
  for (uint32_t& vertex : wall_triangles_) vertex += static_cast<uint32_t>(first_wall);
}

}  // namespace viscera
