// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "surface/wounds/wound_cells.h"
#include "surface/wounds/wound_skin.h"
#include "surface/wounds/wound_walls.h"
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
  void makeWhole();  ///< as if nothing had been cut

  /// [vertices] of the skin's own and the added ones; slots of the body.
  const std::vector<layout::SkinBinding>& bindings() const { return bindings_; }
  /// Vertices of the skin's own whose bindings are not those of the uncut skin.
  const std::vector<uint32_t>& rebound() const { return skin_.rebound(); }
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
  /// Indices into wallVertices() of those that the last update has changed: all others are where they were.
  const std::vector<uint32_t>& changedWalls() const { return walls_.changed(); }
  bool any() const { return cells_.any(); }  ///< is any axial spring cut?
  size_t slivers() const { return skin_.slivers(); }
  size_t holes() const { return walls_.holes(); }
  /// What the last update has looked at or made again, beyond copies of what there was: for tests and benchmarks.
  struct Work {
    size_t cells = 0;      ///< whose springs may be others than before
    size_t pieces = 0;     ///< triangles of the skin
    size_t triangles = 0;  ///< of walls
    size_t points = 0;     ///< of walls, each as often as it was asked to give way
    size_t bindings = 0;   ///< of vertices
    size_t all() const { return cells + pieces + triangles + points + bindings; }
  };
  const Work& work() const { return work_; }

 private:
  CutCells cells_;
  void follow();
  void bindSkin();
  void bindWalls();

  std::vector<layout::SkinBinding> own_bindings_, bindings_;
  std::vector<layout::SkinBinding> lip_bindings_, wall_bindings_;  ///< as they follow in bindings_
  WoundSkin skin_;
  WoundWalls walls_;
  std::vector<uint32_t> wall_triangles_;
  Work work_;
};

}  // namespace viscera
