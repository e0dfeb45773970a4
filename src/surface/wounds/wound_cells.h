// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/model/body/lattice.h"

namespace viscera {

/// A cell with an axial spring that a blade has crossed, other than between two nodes without springs. Corner c is the
/// one at (c & 1, c >> 1 & 1, c >> 2). Edge 4 a + k is the k-th along axis a, counted by its other two coordinates, the
/// first of them fastest.
struct CutCell {
  Vector3i at = Vector3i::Zero();      ///< of its lowest corner, in cells
  std::array<uint32_t, 8> slots{};     ///< of its corners
  std::array<float, 12> crossed{};     ///< position along each edge, 0..1 from its lower end; 0.5 where it is intact
  uint32_t cut = 0;                    ///< a bit per edge; 0: the cell is whole again
  uint64_t order = 0;                  ///< order of cells, independent of the order of cuts
  std::array<uint8_t, 8> component{};  ///< of each corner: the lowest corner that it is connected to by intact edges
  Vector3f centre = Vector3f::Constant(0.5F);  ///< of its wound: mean of the crossings on its edges
  std::array<Eigen::Vector2f, 6>
      face_centre;  ///< the same of face 2 a + side, by its other two axes in ascending order

  /// Returns the corner on the same side of the wound as a point. Divides the cell into 48 tetrahedra, each of its
  /// centre, the centre of a face, the crossing on an edge of that face, and a corner at that edge. Exact on flat cuts,
  /// and the same on both sides of a face that two cells share. @param place  0..1 within the cell
  int cornerAt(const Vector3f& position) const;
  bool holds(uint32_t slot) const { return cornerOf(slot) >= 0; }
  int cornerOf(uint32_t slot) const;  ///< -1 where the slot is none of its corners
};

/// Returns the two corners of an edge of a cell.
inline std::array<int, 2> edgeCorners(int edge) {
  const int axis = edge / 4, u = (axis + 1) % 3 < (axis + 2) % 3 ? (axis + 1) % 3 : (axis + 2) % 3, v = 3 - axis - u;
  const int low = (edge & 1) << u | (edge >> 1 & 1) << v;
  return {low, low | 1 << axis};
}

/// A place in a body, with its cell and its side of a wound.
struct WoundPoint {
  uint32_t cell = 0;  ///< slot of the lowest corner of the cell that holds the point, or of the nearest one
  Vector3f within = Vector3f::Zero();  ///< 0..1 in that cell; for a point outside, its nearest place there
  uint32_t node = 0;                   ///< slot of the node on the same side of the wound
};

/// The cut cells of one body's lattice (docs/surface.md). Cells here are those that are tissue, fully or partly. An
/// update compares the springs of every node with those of the last update, and recomputes cells around changed nodes.
class CutCells {
 public:
  explicit CutCells(const Lattice& lattice);

  /// Updates the cut cells. @param nodes  [slots] of this body   @param axial_cut  [3 * slots] see CutSprings; null:
  /// unchanged
  void update(const layout::NodeBits* nodes, const float* axial_cut);
  void makeWhole();

  /// Returns the cut cells. A cell keeps its number until the body is whole again.
  const std::vector<CutCell>& cells() const { return cells_; }
  bool any() const { return cut_cells_ > 0; }           ///< whether any axial spring is cut
  bool isWhole() const { return severed_nodes_ == 0; }  ///< whether no node has lost a spring
  /// Returns the cut cell by its lowest corner's slot; null where the cell is whole.
  const CutCell* find(uint32_t lowest) const {
    const uint32_t number = numbers_[lowest];
    return number == 0 || cells_[number - 1].cut == 0 ? nullptr : &cells_[number - 1];
  }
  uint32_t numberOf(uint32_t lowest) const { return numbers_[lowest] - 1; }  ///< of a cell in cells()
  /// Returns the nodes with springs, or cut positions, that the last update has found changed; ascending.
  const std::vector<uint32_t>& changedSlots() const { return changed_slots_; }
  /// Returns the lowest corners' slots of the cells around them.
  const std::vector<uint32_t>& changedCells() const { return changed_cells_; }
  /// Visits the cells within `reach` cells of those, by their lowest corner's slot; one cell maybe more than once.
  template <class Visit>
  void forEachCellNear(int reach, Visit visit) const;
  WoundPoint positionOf(const Vector3d& point) const;
  /// Returns whether a node has lost all of its springs, as erased nodes have. It stays where it is, and its side is
  /// not shown.
  bool isGone(uint32_t slot) const;
  bool isSevered(uint32_t slot) const { return (nodes_[slot].lo & layout::kSeveredBit) != 0; }  ///< lost any spring
  bool isAlive(uint32_t slot, uint32_t spring) const { return springCount(nodes_[slot], spring) != 0; }
  /// Returns whether two nodes that share a cell are on two sides of a wound.
  bool areParted(uint32_t node, uint32_t other) const;

  const Lattice& lattice() const { return lattice_; }
  int64_t slotAt(const Vector3i& node) const;  ///< as Lattice's, faster
  bool isCell(const Vector3i& at) const;

 private:
  Vector3i nearestCell(const Vector3d& point) const;
  void findChanged(const layout::NodeBits* nodes, const float* axial_cut);
  void clear();
  bool isCut(uint32_t low, uint32_t high, int axis) const;
  void updateCell(uint32_t lowest);
  void complete(CutCell& cell) const;

  const Lattice& lattice_;
  Vector3i bricks_per_axis_;
  std::vector<uint32_t> brick_at_;       ///< [bricks of the bounding box] 1 + brick, 0 where there is none
  std::vector<layout::NodeBits> nodes_;  ///< [slots] of the last update
  std::vector<float> axial_cut_;         ///< [3 * slots] likewise
  std::vector<uint32_t> numbers_;        ///< [slots] of the cell with this lowest corner: 1 + index into cells_, or 0
  std::vector<CutCell> cells_;
  std::vector<uint32_t> changed_slots_, changed_cells_;
  std::vector<uint32_t> seen_;  ///< [slots] by their cells: the last update that has visited it
  uint32_t mark_ = 0;
  size_t cut_cells_ = 0, severed_nodes_ = 0;
};

template <class Visit>
void CutCells::forEachCellNear(int reach, Visit visit) const {
  const size_t count = changed_slots_.size();
  for (size_t first = 0, end = 0; first < count; first = end) {  // brick by brick: the box around its changes
    Vector3i low = lattice_.nodeAt(changed_slots_[first]), high = low;
    const auto is_here = [&](uint32_t slot) {
      return slot / layout::kBrickSlots == changed_slots_[first] / layout::kBrickSlots;
    };
    for (end = first; end < count && is_here(changed_slots_[end]); ++end) {
      const Vector3i at = lattice_.nodeAt(changed_slots_[end]);
      low = low.cwiseMin(at);
      high = high.cwiseMax(at);
    }
    low.array() -= 1 + reach;  // cells below a node
    high.array() += reach;
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) {
          const int64_t slot = slotAt({x, y, z});
          if (slot >= 0 && lattice_.cell_labels[static_cast<size_t>(slot)] != 0) visit(static_cast<uint32_t>(slot));
        }
  }
}

}  // namespace viscera
