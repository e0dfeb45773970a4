// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "surface/wounds/wound_cells.h"
#include "viscera/model/body/skin.h"

namespace viscera {

/// Lists of numbers: list i is values[starts[i]] to values[starts[i + 1] - 1].
struct NumberLists {
  std::vector<uint32_t> starts, values;

  /// Fills the lists. @param pairs  (i, value), in any order   @param count  of lists
  void fill(std::vector<std::array<uint32_t, 2>> pairs, size_t count);
  template <class Visit>
  void forEach(uint32_t list, Visit visit) const {
    for (uint32_t i = starts[list]; i < starts[list + 1]; ++i) visit(values[i]);
  }
};

/// Spatial index of an uncut surface mesh, so that a wound visits only what is around it.
struct WoundSkinIndex {
  static constexpr uint32_t kNone = UINT32_MAX;

  WoundSkinIndex(const Skin& skin, const Lattice& lattice);

  std::vector<Vector3d> points;                         ///< [vertices] at rest, in cells from the lattice's origin
  std::vector<Vector3f> normals;                        ///< [vertices]
  std::vector<WoundPoint> positions;                    ///< [vertices] in the uncut lattice
  std::vector<std::array<uint32_t, 2>> edges;           ///< lower vertex first
  std::vector<std::array<uint32_t, 3>> triangle_edges;  ///< 01, 12, 20
  std::vector<std::array<uint32_t, 2>> edge_triangles;  ///< [edges] the first two that have it, or kNone
  NumberLists of_cells;                                 ///< triangles in a cell, by its lowest corner's slot
  NumberLists cells_of;                                 ///< those cells, by triangle
  NumberLists of_slots;                                 ///< vertices that depend on springs of a slot
  double longest = 0;                                   ///< edge, in cells

 private:
  void addEdges(const TriangleMesh& mesh);
  void listCells(const TriangleMesh& mesh, const CutCells& whole, size_t slots);
};

}  // namespace viscera
