// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "surface/wound_cells.h"
#include "surface/wound_skin.h"
#include "surface/wound_walls.h"
#include "viscera/layout/skin.h"

namespace viscera {

/// The skin of one body on a lattice after cuts, closed: split along the blade's path, with walls inside
/// (docs/wounds.md). Vertices are the skin's own, then those that cuts have added.
class BodyWound {
 public:
  /// @param skin, lattice  of one body; must outlive this
  BodyWound(const Skin& skin, const Lattice& lattice);

  /// What blades have left of the lattice. @param nodes, axial_cut  see CutCells::update
  void update(const layout::NodeBits* nodes, const float* axial_cut);

  /// [vertices] of the skin's own and the added ones; slots of the body.
  const std::vector<layout::SkinBinding>& bindings() const { return bindings_; }
  /// Vertices of the skin's own whose bindings are not those of the uncut skin.
  const std::vector<uint32_t>& rebound() const { return rebound_; }
  size_t ownVertices() const { return own_bindings_.size(); }
  const std::vector<uint32_t>& skinTriangles() const { return skin_.triangles(); }  ///< [3 * n]
  /// [n] which triangle of the uncut skin each of skinTriangles() is a piece of.
  const std::vector<uint32_t>& skinSources() const { return skin_.sources(); }
  const std::vector<uint32_t>& wallTriangles() const { return wall_triangles_; }  ///< [3 * n]
  /// Added vertices follow the skin's own: first those of the skin's lips, then those of walls.
  const std::vector<WoundVertex>& lipVertices() const { return skin_.added(); }
  const std::vector<WoundVertex>& wallVertices() const { return walls_.vertices(); }
  /// Is an added vertex where a wound ends, one for both of its sides?
  bool isEnd(size_t vertex) const { return vertex < firstWallVertex() && skin_.isEnd(static_cast<uint32_t>(vertex)); }
  size_t firstWallVertex() const { return own_bindings_.size() + skin_.added().size(); }
  bool any() const { return !cells_.cells().empty(); }  ///< is any axial spring cut?
  size_t slivers() const { return skin_.slivers(); }
  size_t holes() const { return walls_.holes(); }

 private:
  CutCells cells_;
  std::vector<layout::SkinBinding> own_bindings_, bindings_;
  std::vector<uint32_t> rebound_;
  std::vector<bool> is_rebound_;  ///< [own vertices]
  WoundSkin skin_;
  WoundWalls walls_;
  std::vector<uint32_t> wall_triangles_;
};

}  // namespace viscera
