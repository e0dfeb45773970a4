// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "surface/wounds/wounds.h"
#include "viscera/model/model.h"
#include "viscera/surface/shown_mesh.h"

namespace viscera {

/// Indices of triangles that are drawn, of those that lie in a buffer.
struct IndexRun {
  size_t first = 0, count = 0;
};
using IndexRuns = std::vector<IndexRun>;

/// Appends what is shown of one triangle: three vertex indices per piece, counter-clockwise from outside.
/// Twin of shaders/surface/split_triangles.comp.
/// @param corners  [3] its vertices
/// @param splits   [6] split vertices on the edges 01, 12, 20, first the one beside the edge's first corner; null where
///                 nothing can split
/// @param alive    0 torn, 1 whole, or the pieces that are left (layout::kShownCorner, kShownRest)
void appendShown(const uint32_t* corners, const uint32_t* splits, uint32_t alive, std::vector<uint32_t>& out);

/// Makes of the codes of what is left of each triangle the triangles that are shown.
class ShownTriangles {
 public:
  ShownTriangles() = default;
  /// @param indices  [3 * triangles] of the skins of all bodies, in the model's order; vertices are numbered through
  /// @param splits   [6 * triangles] as in appendShown, or empty where nothing can split
  ShownTriangles(const Model& model, size_t vertices, std::vector<uint32_t> indices, std::vector<uint32_t> splits);

  size_t count() const { return indices_.size() / 3; }
  size_t trianglesOf(size_t body) const { return body_triangles_[body]; }
  const std::vector<uint32_t>& indices() const { return indices_; }
  const std::vector<uint32_t>& splits() const { return splits_; }
  /// All triangles.
  const std::shared_ptr<const ShownTopology>& whole() const { return whole_; }
  /// What is shown: the same topology as the last time while the codes and the wounds are the same.
  /// @param alive  [triangles] codes as in appendShown, of bodies without wounds   @param wounds  null: none can be
  const std::shared_ptr<const ShownTopology>& shown(const uint32_t* alive, const ShownWounds* wounds = nullptr);

 private:
  std::vector<uint32_t> indices_, splits_, alive_;
  std::vector<size_t> body_triangles_;  ///< [bodies]
  void appendBody(size_t body, size_t first_triangle, const ShownWounds* wounds, ShownTopology& out) const;
  std::shared_ptr<const ShownTopology> whole_, shown_;
  uint64_t wounds_revision_ = 0;
  uint64_t revisions_ = 1;
};

}  // namespace viscera
