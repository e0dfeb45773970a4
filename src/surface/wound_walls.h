// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "surface/wound_cells.h"
#include "surface/wound_skin.h"

namespace viscera {

/// The walls of the wounds of one body (docs/wounds.md 3): surface nets of its cut springs, sewn to the lips of the
/// skin. A cut cell has one point, the mean of where its springs and the skin in it are cut, and a vertex there for
/// each side; a cut spring inside the tissue has two quads between the points of the four cells around it; a lip is
/// joined to its cell's point, and where lips go on in another cell, both cells' points to the vertex between; small
/// rings that this leaves are filled. Both sides are in one place at rest, and every edge has one triangle on either
/// hand.
class WoundWalls {
 public:
  void update(const CutCells& cells, const WoundSkin& skin);

  /// [3 * n] indices into vertices().
  const std::vector<uint32_t>& triangles() const { return triangles_; }
  const std::vector<WoundVertex>& vertices() const { return vertices_; }
  /// Wounds that cannot be closed since they run out of the skin at a border of it.
  size_t holes() const { return holes_; }

 private:
  void findPoints();
  void addQuads();
  void addFans();
  void closeHoles();
  void closeRing(std::vector<uint32_t> ring);
  bool isInside(uint32_t slot, int axis) const;
  uint8_t sideOf(uint32_t cell, uint32_t node) const;
  uint32_t pointVertex(uint32_t cell, uint8_t component);
  uint32_t lipVertex(uint32_t skin_vertex);
  void add(uint32_t a, uint32_t b, uint32_t c);
  void findNormals();

  const CutCells* cells_ = nullptr;
  const WoundSkin* skin_ = nullptr;
  std::vector<uint32_t> triangles_;
  std::vector<WoundVertex> vertices_;
  std::unordered_map<uint32_t, Vector3d> points_;          ///< of cells, by their lowest corners
  std::unordered_map<uint64_t, uint32_t> point_vertices_;  ///< of a cell's component
  std::unordered_map<uint32_t, uint32_t> lip_vertices_;    ///< of a vertex of the skin
  size_t holes_ = 0;
};

}  // namespace viscera
