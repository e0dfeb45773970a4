// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/model/shape/solid.h"

namespace viscera::test {

/// Returns the cell that contains a point.
inline Vector3i cellAt(const Solid& solid, const Vector3d& point_m) {
  return ((point_m - solid.origin_m) / solid.spacing_m).array().floor().cast<int>();
}

inline uint16_t labelAt(const Solid& solid, const Vector3d& point_m) {
  const Vector3i cell = cellAt(solid, point_m);
  return solid.label(cell.x(), cell.y(), cell.z());
}

/// Cells that share faces, numbered piece by piece from 1; 0 for cells of the other kind. The grid gets a rim of one
/// empty cell, so that cell (x, y, z) is at (x+1, y+1, z+1) and, for empty cells, piece 1 is the outside.
struct Pieces {
  Vector3i cells;
  std::vector<int> piece;
  int count = 0;

  size_t index(const Vector3i& c) const {
    return static_cast<size_t>(c.x()) +
           static_cast<size_t>(cells.x()) * (c.y() + static_cast<size_t>(cells.y()) * c.z());
  }
  int at(const Vector3i& cell) const { return piece[index(cell + Vector3i::Ones())]; }
};

/// Numbers the pieces of a solid. @param is_filled  which cells to number: the filled or the empty ones
inline Pieces findPieces(const Solid& solid, bool is_filled) {
  Pieces found;
  found.cells = solid.cells + Vector3i::Constant(2);
  found.piece.assign(static_cast<size_t>(found.cells.prod()), 0);
  const auto wanted = [&](const Vector3i& c) {
    return (solid.label(c.x() - 1, c.y() - 1, c.z() - 1) != 0) == is_filled && found.piece[found.index(c)] == 0;
  };
  for (int i = 0; i < found.cells.prod(); ++i) {
    const Vector3i seed(i % found.cells.x(), i / found.cells.x() % found.cells.y(),
                        i / found.cells.x() / found.cells.y());
    if (!wanted(seed)) continue;
    std::vector<Vector3i> open = {seed};
    found.piece[found.index(seed)] = ++found.count;
    while (!open.empty()) {
      const Vector3i cell = open.back();
      open.pop_back();
      for (int side = 0; side < 6; ++side) {
        Vector3i next = cell;
        next[side / 2] += side % 2 ? 1 : -1;
        if ((next.array() < 0).any() || (next.array() >= found.cells.array()).any() || !wanted(next)) continue;
        found.piece[found.index(next)] = found.count;
        open.push_back(next);
      }
    }
  }
  return found;
}

inline size_t countPieces(const Solid& solid) {
  return static_cast<size_t>(findPieces(solid, true).count);
}

/// Returns whether a path of empty cells leads from outside to the cell at a point.
inline bool outsideReaches(const Solid& solid, const Vector3d& point_m) {
  return findPieces(solid, false).at(cellAt(solid, point_m)) == 1;
}

}  // namespace viscera::test
