// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "viscera/layout/nodes.h"
#include "viscera/model/body/neighbors.h"
#include "viscera/model/scene/body_kinds.h"
#include "viscera/model/shape/solid.h"

namespace viscera {

/// Implicitly connected lattice of one body: nodes at the corners of the solid's cells, in 4x4x4 bricks.
struct Lattice {
  double spacing_m = 0;
  Vector3d origin_m = Vector3d::Zero();  ///< rest position of node (0,0,0), tissue frame
  Vector3i nodes_per_axis = Vector3i::Zero();
  std::vector<layout::Brick> bricks;    ///< [bricks] ordered by (z, y, x); body is 0 here
  std::vector<layout::NodeBits> nodes;  ///< [64 * bricks] all-zero where no node is
  std::vector<uint16_t> labels;         ///< [64 * bricks] 0 no node, else 1 + part of a cell around it
  std::vector<uint16_t> cell_labels;    ///< [64 * bricks] of the cell whose lowest corner is the node: 0 none, else
                                        ///< 1 + part
  std::vector<CellFill> fills;          ///< of the cells that are tissue in part; empty where all are full
  std::vector<uint32_t> cell_fills;     ///< [64 * bricks] of the cell whose lowest corner is the node: 0 full or none,
                                        ///< else 1 + index into fills; empty where all are full
  std::vector<PartFill> shared;         ///< of cells on the border of parts what each part has, ascending
  /// [64 * bricks] how deep a node lies below the true surface at rest [m], negative outside, at most spacing_m; empty
  /// where all cells are full. Exact for meshes and boxes, but too little where parts end within each other.
  std::vector<float> depth_m;
  /// [64 * bricks] from a node outside of the true surface to the nearest point of it at rest [m], 0 of all others;
  /// empty where all cells are full.
  std::vector<Eigen::Vector3f> way_to_surface_m;
  std::vector<uint32_t> active_slots;  ///< [active] slots of nodes, ascending
  std::vector<std::string> part_names;

  /// Slot of the node at integer coordinates, or -1 where there is none.
  int64_t slotAt(const Vector3i& node) const;
  /// Slot of the neighbour along a spring index, whether or not a spring is there; -1 where there is no node.
  int64_t neighborSlot(uint32_t slot, uint32_t spring) const;
  Vector3i nodeAt(uint32_t slot) const;
  Vector3d restPosition(uint32_t slot) const;  ///< [m], tissue frame
  size_t springs() const;                      ///< each spring once

  std::unordered_map<uint64_t, uint32_t> brick_index;  ///< packed brick coordinates -> brick
};

/// How much of the cell whose lowest corner is the node is tissue, and where.
inline CellFill fillOf(const Lattice& lattice, uint32_t lowest) {
  const uint32_t fill = lattice.cell_fills.empty() ? 0 : lattice.cell_fills[lowest];
  return fill == 0 ? CellFill{} : lattice.fills[fill - 1];
}

/// Calls visit(corner, slot) for the eight nodes of the cell whose lowest corner is at `lowest`.
template <class Visit>
void forEachCorner(const Lattice& lattice, uint32_t lowest, Visit visit) {
  const Vector3i at = lattice.nodeAt(lowest);
  for (int c = 0; c < 8; ++c) {
    const Vector3i corner(c & 1, (c >> 1) & 1, (c >> 2) & 1);
    visit(corner, static_cast<uint32_t>(lattice.slotAt(at + corner)));
  }
}

/// Nodes of the solid's cells, weights assembled.
/// @throws LatticeError  no filled cell
Lattice buildLattice(const Solid& solid, Weights weights);

}  // namespace viscera
