// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/solid_crumbs.h"

#include <algorithm>
#include <vector>

namespace viscera {
namespace {

/// Cells of the piece around a seed, through faces, edges and corners; marks them as seen.
std::vector<Vector3i> pieceAround(const Vector3i& seed, const Solid& solid, std::vector<bool>& seen) {
  std::vector<Vector3i> piece = {seed};
  seen[solid.index(seed.x(), seed.y(), seed.z())] = true;
  for (size_t next = 0; next < piece.size(); ++next) {
    for (int i = 0; i < 27; ++i) {
      const Vector3i cell = piece[next] + Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      if (solid.label(cell.x(), cell.y(), cell.z()) == 0) continue;
      const size_t at = solid.index(cell.x(), cell.y(), cell.z());
      if (seen[at]) continue;
      seen[at] = true;
      piece.push_back(cell);
    }
  }
  return piece;
}

}  // namespace

int removeCrumbs(Solid& solid, double least_share) {
  std::vector<bool> seen(solid.labels.size(), false);
  std::vector<std::vector<Vector3i>> pieces;
  for (int z = 0; z < solid.cells.z(); ++z) {
    for (int y = 0; y < solid.cells.y(); ++y) {
      for (int x = 0; x < solid.cells.x(); ++x) {
        const size_t at = solid.index(x, y, z);
        if (solid.labels[at] != 0 && !seen[at]) pieces.push_back(pieceAround({x, y, z}, solid, seen));
      }
    }
  }
  size_t largest = 0;
  for (const auto& piece : pieces) largest = std::max(largest, piece.size());
  int removed = 0;
  for (const auto& piece : pieces) {
    if (static_cast<double>(piece.size()) >= least_share * static_cast<double>(largest)) continue;
    for (const Vector3i& cell : piece) solid.labels[solid.index(cell.x(), cell.y(), cell.z())] = 0;
    ++removed;
  }
  return removed;
}

}  // namespace viscera
