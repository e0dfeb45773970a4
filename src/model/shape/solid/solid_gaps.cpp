// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/solid/solid_gaps.h"

#include <algorithm>
#include <array>

#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

/// A grid with this number of cells is traversed in well below a second, whatever its content.
constexpr double kQuickCells = 50e6;
/// Cells of the whole grid over those of its occupied slabs, up to which space between parts is not taken for a
/// mistake. Two lungs have about 1.2.
constexpr double kMostSpread = 8;

/// Interval that a triangle covers along an axis.
struct Extent {
  double from_m, to_m;
  size_t part;
};

/// Distribution of the parts along one axis.
struct Spread {
  double length_m = 0;                     ///< length of all [m]
  double covered_m = 0;                    ///< length outside gaps [m]
  double gap_m = 0;                        ///< width of the widest gap [m]
  size_t part_before = 0, part_after = 0;  ///< parts next to the widest gap
  double before_m = 0;  ///< distance from the start to the widest gap [m]: shows which side of it is smaller
};

Spread spreadOf(const std::vector<NamedShell>& shells, int axis) {
  std::vector<Extent> extents;
  for (size_t s = 0; s < shells.size(); ++s) {
    const Shell& shell = *shells[s].shell;
    for (const auto& t : shell.triangles) {
      const auto [from, to] =
          std::minmax({shell.positions_m[t[0]][axis], shell.positions_m[t[1]][axis], shell.positions_m[t[2]][axis]});
      extents.push_back({from, to, s});
    }
  }
  std::sort(extents.begin(), extents.end(), [](const Extent& a, const Extent& b) { return a.from_m < b.from_m; });
  Spread spread;
  const double start_m = extents.front().from_m;
  Extent farthest = extents.front();
  for (const Extent& next : extents) {
    const double gap_m = next.from_m - farthest.to_m;
    if (gap_m > 0) spread.covered_m -= gap_m;
    if (gap_m > spread.gap_m) {
      spread.gap_m = gap_m;
      spread.part_before = farthest.part;
      spread.part_after = next.part;
      spread.before_m = farthest.to_m - start_m;
    }
    if (next.to_m > farthest.to_m) farthest = next;
  }
  spread.length_m = farthest.to_m - start_m;
  spread.covered_m += spread.length_m;
  return spread;
}

std::array<Spread, 3> spreadsOf(const std::vector<NamedShell>& shells) {
  return {spreadOf(shells, 0), spreadOf(shells, 1), spreadOf(shells, 2)};
}

/// Returns the number of cells of a grid with gaps shortened to `share`.
double cellsAt(const std::array<Spread, 3>& spreads, double share, double spacing_m) {
  double cells = 1;
  for (const Spread& s : spreads) {
    cells *= std::max(1.0, (s.covered_m + share * (s.length_m - s.covered_m)) / spacing_m);
  }
  return cells;
}

int widestAxis(const std::array<Spread, 3>& spreads) {
  const auto widest = std::max_element(spreads.begin(), spreads.end(),
                                       [](const Spread& a, const Spread& b) { return a.gap_m < b.gap_m; });
  return static_cast<int>(widest - spreads.begin());
}

/// Returns "part 'ball' is 100 m from the rest along x". The shorter side of the gap is the stray part.
std::string farPart(const std::vector<NamedShell>& shells, const std::array<Spread, 3>& spreads) {
  const int axis = widestAxis(spreads);
  const Spread& spread = spreads[static_cast<size_t>(axis)];
  const double after_m = spread.length_m - spread.before_m - spread.gap_m;
  const size_t part = after_m <= spread.before_m ? spread.part_after : spread.part_before;
  TextOut out;
  out << (spread.part_before == spread.part_after ? "a piece of part '" : "part '") << shells[part].name << "' is "
      << spread.gap_m << " m from the rest along "
      << "xyz"[axis];
  return out.str();
}

}  // namespace

void requireParted(const std::vector<NamedShell>& shells, double spacing_m) {
  const auto cellsOfBox = [&] {
    Vector3d low = shells.front().shell->min(), high = shells.front().shell->max();
    for (const NamedShell& s : shells) {
      low = low.cwiseMin(s.shell->min());
      high = high.cwiseMax(s.shell->max());
    }
    return ((high - low) / spacing_m).cwiseMax(1.0).prod();
  };
  if (cellsOfBox() <= kQuickCells) return;
  const std::array<Spread, 3> spreads = spreadsOf(shells);
  const double most = std::max(kQuickCells, kMostSpread * cellsAt(spreads, 0, spacing_m));
  if (cellsAt(spreads, 1, spacing_m) <= most) return;
  double fits = 0, does_not = 1;  // shares of the gaps
  for (int halving = 0; halving < 30; ++halving) {
    const double share = 0.5 * (fits + does_not);
    (cellsAt(spreads, share, spacing_m) <= most ? fits : does_not) = share;
  }
  TextOut out;
  out << farPart(shells, spreads) << ", and a grid with spacing_m " << spacing_m << " would be "
      << cellsAt(spreads, 1, spacing_m)
      << " cells, nearly all of them empty; accepted at this spacing: a distance of at most "
      << fits * spreads[static_cast<size_t>(widestAxis(spreads))].gap_m
      << " m. Remove the part, move it, or make it a separate body";
  throw LatticeError(out.str());
}

std::string farPartNote(const std::vector<NamedShell>& shells) {
  constexpr double kFar = 1e3;    // box over the part of it that parts cover
  constexpr double kFine = 1e-9;  // m: so fine that only the ratio of volumes counts
  const std::array<Spread, 3> spreads = spreadsOf(shells);
  return cellsAt(spreads, 1, kFine) > kFar * cellsAt(spreads, 0, kFine) ? "; " + farPart(shells, spreads) : "";
}

}  // namespace viscera
