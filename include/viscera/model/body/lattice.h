// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "viscera/api.h"
#include "viscera/layout/nodes.h"
#include "viscera/model/body/neighbors.h"
#include "viscera/model/scene/body_kinds.h"
#include "viscera/model/shape/solid.h"

namespace VISCERA_PUBLIC viscera {

/// Ghost: position beyond a fixed node at which a row of nodes in a thin wall goes on, so that the wall may bend where
/// it leaves the clamp. It moves freely, has the mass of its fixed node, bears no tissue, and only the second
/// difference at that node depends on it (physics.md 1, Thin walls).
struct RowGhost {
  uint32_t slot;    ///< not among the lattice's active slots
  uint32_t fixed;   ///< slot of its fixed node
  uint32_t spring;  ///< axial spring index from the fixed node to the ghost
};

/// Lattice of one body, connected implicitly: nodes at the corners of the solid's cells, in bricks of 4x4x4.
struct Lattice {
  double spacing_m = 0;
  Vector3d origin_m = Vector3d::Zero();  ///< rest position of node (0,0,0), tissue frame
  Vector3i nodes_per_axis = Vector3i::Zero();
  std::vector<layout::Brick> bricks;    ///< [bricks] ordered by (z, y, x); the body index is 0 here
  std::vector<layout::NodeBits> nodes;  ///< [64 * bricks] all-zero where no node is
  std::vector<uint16_t> labels;         ///< [64 * bricks] 0 no node, else 1 + the part of a cell around it
  std::vector<uint16_t> cell_labels;  ///< [64 * bricks] label of the cell that has the node as its lowest corner: 0 no
                                      ///< cell, else 1 + part
  std::vector<CellFill> fills;        ///< fills of the partly filled cells; empty where all are full
  std::vector<uint32_t> cell_fills;   ///< [64 * bricks] fill of the cell that has the node as its lowest corner: 0 full
                                      ///< or no cell, else 1 + index into fills; empty where all are full
  std::vector<PartFill> shared;       ///< what each part fills of the cells on the border of parts, ascending
  /// [64 * bricks] depth of a node below the true surface at rest [m], negative outside, at most spacing_m; empty where
  /// all cells are full. Exact for meshes and boxes, but too small where parts end within each other.
  std::vector<float> depth_m;
  /// [64 * bricks] vector from a node outside the true surface to the nearest point of it at rest [m], 0 for all
  /// others; empty where all cells are full.
  std::vector<Eigen::Vector3f> offset_to_surface_m;
  std::vector<uint32_t> active_slots;  ///< [active] slots of nodes, ascending
  std::vector<RowGhost> ghosts;        ///< ascending by slot; their bricks may follow all others, out of order
  std::vector<std::string> part_names;

  /// Returns the slot of the node at integer coordinates, or -1 where there is none.
  int64_t slotAt(const Vector3i& node) const;
  /// Returns the slot of the neighbour along a spring index, with or without a spring to it; -1 where there is no node.
  int64_t neighborSlot(uint32_t slot, uint32_t spring) const;
  Vector3i nodeAt(uint32_t slot) const;
  Vector3d restPosition(uint32_t slot) const;  ///< rest position [m], tissue frame
  size_t springs() const;                      ///< number of springs, each counted once

  std::unordered_map<uint64_t, uint32_t> brick_index;  ///< from packed brick coordinates to the index of the brick
};

/// Returns how much of the cell with this lowest corner is tissue, and where.
inline CellFill fillOf(const Lattice& lattice, uint32_t lowest) {
  const uint32_t fill = lattice.cell_fills.empty() ? 0 : lattice.cell_fills[lowest];
  return fill == 0 ? CellFill{} : lattice.fills[fill - 1];
}

/// Calls visit(corner, slot) for the eight nodes of the cell with this lowest corner.
template <class Visit>
void forEachCorner(const Lattice& lattice, uint32_t lowest, Visit visit) {
  const Vector3i at = lattice.nodeAt(lowest);
  for (int c = 0; c < 8; ++c) {
    const Vector3i corner(c & 1, (c >> 1) & 1, (c >> 2) & 1);
    visit(corner, static_cast<uint32_t>(lattice.slotAt(at + corner)));
  }
}

/// Builds the nodes of the solid's cells and assembles their weights.
/// @throws LatticeError  no filled cell
Lattice buildLattice(const Solid& solid, Weights weights);

}  // namespace viscera
