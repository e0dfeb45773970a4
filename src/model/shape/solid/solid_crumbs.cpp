// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/solid/solid_crumbs.h"

#include <algorithm>
#include <vector>

namespace viscera {
namespace {

/// Returns the cells of the piece around a seed, through faces, edges and corners; marks them as seen.
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

/// Returns the share of a labelled cell that is tissue.
double shareOf(const Solid& solid, size_t cell) {
  const auto found = std::lower_bound(solid.partial.begin(), solid.partial.end(), cell,
                                      [](const PartialCell& p, size_t at) { return p.cell < at; });
  return found != solid.partial.end() && found->cell == cell ? found->fill.share : 1;
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
  std::vector<double> volumes;  // in cells
  for (const auto& piece : pieces) {
    double volume = 0;
    for (const Vector3i& cell : piece) volume += shareOf(solid, solid.index(cell.x(), cell.y(), cell.z()));
    volumes.push_back(volume);
  }
  const double largest = pieces.empty() ? 0 : *std::max_element(volumes.begin(), volumes.end());
  int removed = 0;
  for (size_t p = 0; p < pieces.size(); ++p) {
    if (volumes[p] >= least_share * largest) continue;
    for (const Vector3i& cell : pieces[p]) solid.labels[solid.index(cell.x(), cell.y(), cell.z())] = 0;
    ++removed;
  }
  const auto emptied = [&](const PartialCell& p) { return solid.labels[p.cell] == 0; };
  solid.partial.erase(std::remove_if(solid.partial.begin(), solid.partial.end(), emptied), solid.partial.end());
  return removed;
}

}  // namespace viscera
