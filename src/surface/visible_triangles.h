// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "surface/wounds/wounds.h"
#include "viscera/model/model.h"
#include "viscera/surface/visible_mesh.h"

namespace viscera {

/// A run of indices of drawn triangles in a buffer.
struct IndexRun {
  size_t first = 0, count = 0;
};
using IndexRuns = std::vector<IndexRun>;

/// Appends the shown pieces of one triangle: three vertex indices per piece, counter-clockwise from outside. Must agree
/// with shaders/surface/split_triangles.comp.
/// @param corners  [3] its vertices
/// @param splits   [6] split vertices on the edges 01, 12, 20, first the one near the edge's first corner; null where
///                 nothing can split
/// @param alive    0 torn, 1 whole, or the pieces that are left (layout::kShownCorner, kShownRest)
void appendShown(const uint32_t* corners, const uint32_t* splits, uint32_t alive, std::vector<uint32_t>& out);

/// Makes shown triangles from the codes of which pieces are left of each triangle.
class VisibleTriangles {
 public:
  VisibleTriangles() = default;
  /// @param indices  [3 * triangles] of the surface meshes of all bodies, in the model's order, with global vertex
  /// numbers
  /// @param splits   [6 * triangles] as in appendShown, or empty where nothing can split
  VisibleTriangles(const Model& model, size_t vertices, std::vector<uint32_t> indices, std::vector<uint32_t> splits);

  size_t count() const { return indices_.size() / 3; }
  size_t trianglesOf(size_t body) const { return body_triangles_[body]; }
  const std::vector<uint32_t>& indices() const { return indices_; }
  const std::vector<uint32_t>& splits() const { return splits_; }
  /// Returns all triangles.
  const std::shared_ptr<const VisibleTopology>& whole() const { return whole_; }
  /// Returns the shown triangles. Returns the same topology while the codes and the wounds are the same.
  /// @param alive  [triangles] codes as in appendShown, of bodies without wounds   @param wounds  null: there are none
  const std::shared_ptr<const VisibleTopology>& shown(const uint32_t* alive, const VisibleWounds* wounds = nullptr);

 private:
  std::vector<uint32_t> indices_, splits_, alive_;
  std::vector<size_t> body_triangles_;  ///< [bodies]
  void appendBody(size_t body, size_t first_triangle, const VisibleWounds* wounds, VisibleTopology& out) const;
  std::shared_ptr<const VisibleTopology> whole_, shown_;
  uint64_t wounds_revision_ = 0;
  uint64_t revisions_ = 1;
};

}  // namespace viscera
