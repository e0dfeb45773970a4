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

/// The closed surface mesh of one body on a lattice after cuts: split along the blade's path, with walls inside
/// (docs/surface.md). Vertices are the mesh's own, then those that cuts have added.
class BodyWound {
 public:
  /// @param skin, lattice  of one body; must outlive this
  BodyWound(const Skin& skin, const Lattice& lattice);

  /// Updates the wounds to the springs that are left. @param nodes, axial_cut  see CutCells::update
  void update(const layout::NodeBits* nodes, const float* axial_cut);
  void makeWhole();  ///< undoes all cuts

  /// Returns the bindings of own and added vertices [vertices], with slots of the body.
  const std::vector<layout::SkinBinding>& bindings() const { return bindings_; }
  /// Returns the own vertices with bindings that differ from the uncut mesh.
  const std::vector<uint32_t>& rebound() const { return skin_.rebound(); }
  size_t ownVertices() const { return own_bindings_.size(); }
  const std::vector<uint32_t>& skinTriangles() const { return skin_.triangles(); }  ///< [3 * n]
  /// Returns the triangle of the uncut mesh [n] that each of skinTriangles() is a piece of.
  const std::vector<uint32_t>& skinSources() const { return skin_.sources(); }
  const std::vector<uint32_t>& wallTriangles() const { return wall_triangles_; }  ///< [3 * n]
  /// Returns added vertices, which follow the mesh's own: first those of lips, then those of walls.
  const std::vector<WoundVertex>& lipVertices() const { return skin_.added(); }
  const std::vector<WoundVertex>& wallVertices() const { return walls_.vertices(); }
  /// Returns whether an added vertex is the end of a wound, which both of its sides share.
  bool isEnd(size_t vertex) const { return vertex < firstWallVertex() && skin_.isEnd(static_cast<uint32_t>(vertex)); }
  size_t firstWallVertex() const { return own_bindings_.size() + skin_.added().size(); }
  /// Returns indices into wallVertices() of those that the last update has changed; all others are where they were.
  const std::vector<uint32_t>& changedWalls() const { return walls_.changed(); }
  bool any() const { return cells_.any(); }  ///< whether any axial spring is cut
  size_t slivers() const { return skin_.slivers(); }
  size_t holes() const { return walls_.holes(); }
  /// Work of the last update beyond copies of the old state, for tests and benchmarks.
  struct Work {
    size_t cells = 0;      ///< with springs that may have changed
    size_t pieces = 0;     ///< triangles of the surface mesh
    size_t triangles = 0;  ///< of walls
    size_t points = 0;     ///< of walls, counted once per relaxation
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
  std::vector<layout::SkinBinding> lip_bindings_, wall_bindings_;  ///< in the order of bindings_
  WoundSkin skin_;
  WoundWalls walls_;
  std::vector<uint32_t> wall_triangles_;
  Work work_;
};

}  // namespace viscera
