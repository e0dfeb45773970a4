// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "viscera/model/shape/solid.h"

namespace viscera {

/// Half of a face of a solid cell to which a surface vertex is bound, and the position on it (EGVE eq 4). Node 0 is at
/// the right angle, so edges 0-1 and 2-0 are axial springs and edge 1-2 is a face diagonal.
struct Anchor {
  std::array<Vector3i, 3> nodes;    ///< counter-clockwise seen from outside the cell
  double weight1 = 0, weight2 = 0;  ///< weights of nodes 1 and 2, 0..1; node 0 has the rest
  bool deep = false;                ///< on a face of the vertex's own cell, not on the boundary of the solid
  std::optional<Vector3i> cell;     ///< cell around the vertex, where the vertex moves with the cell's tissue
};

/// Returns the anchor with the same face cut in two so that the node nearest to the position is node 0, and the
/// position at that node.
Anchor atNearestNode(const Anchor& anchor);

/// Search for anchors on the faces of a solid's cells.
class AnchorFinder {
 public:
  explicit AnchorFinder(const Solid& solid) : solid_(solid) {}

  /// Returns the nearest point on the boundary of the solid, or on the vertex's own cell where the boundary is farther
  /// than a cell. In walls of about a cell both sides are near: a boundary face that looks away from `outward` counts
  /// as farther, up to one spacing. In a solid with partly filled cells the tissue does not end at the boundary. The
  /// result is then on a face of the cell around the vertex, or of the nearest cell within half a cell of it.
  /// @param point_m  tissue frame  @param outward  unit normal of the surface mesh there
  /// @param in_cells  false: on the boundary in such a solid too
  Anchor find(const Vector3d& point_m, const Vector3d& outward, bool in_cells = true) const;

 private:
  struct Face {
    Vector3i cell = Vector3i::Zero();
    int axis = 0, side = 0;  // side 1 looks along +axis
    double distance2 = 0;    // squared distance from the point, in cells
  };
  Face nearestFaceOf(const Vector3i& cell, const Vector3d& point) const;
  Face nearestBoundary(const Vector3d& point, const Vector3d& outward) const;
  template <class Visit>
  void forEachCellOfShell(const Vector3i& center, int radius, Visit visit) const;
  bool filled(const Vector3i& cell) const { return solid_.label(cell.x(), cell.y(), cell.z()) != 0; }

  const Solid& solid_;
};

}  // namespace viscera
