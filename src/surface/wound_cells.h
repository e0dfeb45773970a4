// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/model/body/lattice.h"

namespace viscera {

/// A cell with an axial spring that a blade has crossed, other than between two nodes without springs. Corner c is the
/// one at (c & 1, c >> 1 & 1, c >> 2); edge 4 a + k is the k-th along axis a, counted by its other two coordinates, the
/// first of them fastest.
struct CutCell {
  Vector3i at = Vector3i::Zero();      ///< of its lowest corner, in cells
  std::array<uint32_t, 8> slots{};     ///< of its corners
  std::array<float, 12> crossed{};     ///< where along each edge, 0..1 from its lower end; 0.5 where it is whole
  uint32_t cut = 0;                    ///< a bit per edge
  std::array<uint8_t, 8> component{};  ///< of each corner: its lowest corner that whole edges join it to
  Vector3f centre = Vector3f::Constant(0.5F);  ///< of its wound: mean of where its edges are cut
  std::array<Eigen::Vector2f, 6>
      face_centre;  ///< the same of face 2 a + side, by its other two axes in ascending order

  /// The corner on whose side of the wound a point lies. A cell is seen as 48 tetrahedra, each of its centre, the
  /// centre of a face, the crossing on an edge of that face, and a corner at that edge: exact on flat cuts, and the
  /// same on both sides of a face that two cells share. @param place  0..1 within the cell
  int cornerAt(const Vector3f& place) const;
  bool holds(uint32_t slot) const { return cornerOf(slot) >= 0; }
  int cornerOf(uint32_t slot) const;  ///< -1 where the slot is none of its corners
};

/// The two corners of an edge of a cell.
inline std::array<int, 2> edgeCorners(int edge) {
  const int axis = edge / 4, u = (axis + 1) % 3 < (axis + 2) % 3 ? (axis + 1) % 3 : (axis + 2) % 3, v = 3 - axis - u;
  const int low = (edge & 1) << u | (edge >> 1 & 1) << v;
  return {low, low | 1 << axis};
}

/// A place in a body as its wounds see it.
struct WoundPlace {
  uint32_t cell = 0;  ///< slot of the lowest corner of the cell that holds the point, or of the nearest one
  Vector3f within = Vector3f::Zero();  ///< 0..1 in that cell; of a point outside of it its nearest place
  uint32_t node = 0;                   ///< slot of the node on whose side the point lies
};

/// The cut cells of one body's lattice (docs/wounds.md 1). Cells here are those that are tissue, whole or in part.
class CutCells {
 public:
  explicit CutCells(const Lattice& lattice);

  /// @param nodes  [slots] of this body   @param axial_cut  [3 * slots] see CutState
  void update(const layout::NodeBits* nodes, const float* axial_cut);

  const std::vector<CutCell>& cells() const { return cells_; }
  /// The cut cell of the lowest corner's slot; null where the cell is whole.
  const CutCell* find(uint32_t lowest) const { return numbers_[lowest] == 0 ? nullptr : &cells_[numbers_[lowest] - 1]; }
  uint32_t numberOf(uint32_t lowest) const { return numbers_[lowest] - 1; }  ///< of a cut cell, in cells()
  WoundPlace placeOf(const Vector3d& point) const;
  const std::vector<uint32_t>& severed() const { return severed_; }  ///< slots that have lost springs
  /// Has a node lost all of its springs, as erased ones have? It stays where it is, and nothing is shown of its side.
  bool isGone(uint32_t slot) const;
  bool isAlive(uint32_t slot, uint32_t spring) const { return springCount(nodes_[slot], spring) != 0; }
  /// Do two nodes that share a cell lie on two sides of a wound?
  bool areParted(uint32_t node, uint32_t other) const;

  const Lattice& lattice() const { return lattice_; }
  int64_t slotAt(const Vector3i& node) const;  ///< as Lattice's, faster
  bool isCell(const Vector3i& at) const;

 private:
  Vector3i nearestCell(const Vector3d& point) const;
  void addAround(uint32_t slot, int axis);
  void complete(CutCell& cell, const float* axial_cut) const;

  const Lattice& lattice_;
  Vector3i bricks_per_axis_;
  std::vector<uint32_t> brick_at_;  ///< [bricks of the bounding box] 1 + brick, 0 where there is none
  std::vector<layout::NodeBits> nodes_;
  std::vector<uint32_t> numbers_;  ///< [slots] of the cell whose lowest corner it is: 1 + index into cells_, or 0
  std::vector<CutCell> cells_;
  std::vector<uint32_t> severed_;
};

}  // namespace viscera
