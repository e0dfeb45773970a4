// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Part of each cell that is tissue. Cells without a surface in them are full or empty like their centre (rules 1 to 5
// of docs/volumes.md). In the others the integrals of each part's winding number are exact. The union of overlapping
// parts, or a part that overlaps itself, is however not their sum. Therefore all parts are also sampled along 4 x 4
// lines per cell, where a union is a union of intervals. The exact integrals then correct what the lines missed of each
// part, as far as it is visible from outside the others.
#include "model/shape/solid/solid_moments.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_map>

#include "model/shape/solid/cell_fill.h"
#include "model/shape/solid/winding_sums.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr int kLines = 4;                 ///< lines along an edge of a cell
constexpr double kLinesAtOnce = 1 << 20;  ///< at most about 100 MB of intervals

/// Contribution of one part to a cell that its surface passes through.
struct PartCell {
  CellFill exact;               ///< integrals of the winding number
  CellFill sampled = noFill();  ///< sum along lines
  double own = 0;               ///< share along lines, without smaller parts
  int winding = 0;              ///< winding number along all lines; 0: no line met it
  bool is_plain = true;         ///< the winding number has one value wherever it is not 0
};

/// Cell with a surface in it.
struct UnionCell {
  size_t cell;
  CellFill sampled = noFill();
  CellFill correction = noFill();
  uint16_t largest_label = 0;  ///< label of the part with the largest share
  double largest_share = 0;
};

/// Interval of a line, in cells.
struct LineStretch {
  int u, v;      ///< index of the line: kLines per cell, from the start of the slab
  size_t order;  ///< index of the volume
  double from, to;
  int winding;
};

using Interval = std::pair<double, double>;

/// Disjoint intervals of a line, in order.
class Covered {
 public:
  /// Adds an interval, and calls visit(from, to) for what was not covered before.
  template <class Visit>
  void add(Interval more, Visit visit) {
    std::vector<Interval> kept;
    double at = more.first;
    for (const Interval& i : intervals_) {
      if (i.second < more.first || i.first > more.second) {
        kept.push_back(i);
        continue;
      }
      if (i.first > at) visit(at, i.first);
      at = std::max(at, i.second);
      more = {std::min(more.first, i.first), std::max(more.second, i.second)};
    }
    if (at < more.second) visit(at, more.second);
    kept.push_back(more);
    std::sort(kept.begin(), kept.end());
    intervals_.swap(kept);
  }
  void clear() { intervals_.clear(); }

 private:
  std::vector<Interval> intervals_;
};

class MomentFiller {
 public:
  MomentFiller(const std::vector<Volume>& volumes, Solid& solid)
      : volumes_(volumes),
        solid_(solid),
        parts_(volumes.size()),
        own_(volumes.size()),
        union_of_(solid.labels.size(), 0) {}

  void addSurface(size_t order) {
    for (const SurfaceCell& found : windingSums(volumes_[order].shell, solid_)) {
      uint32_t& known = union_of_[found.cell];
      if (known == 0) {
        cells_.push_back({found.cell});
        known = static_cast<uint32_t>(cells_.size());
      }
      parts_[order][known - 1] = {found.sum};
    }
  }

  int layersAtOnce() const { return std::max(1, static_cast<int>(kLinesAtOnce / kLines / kLines / solid_.cells.y())); }

  /// Samples the layers of cells first .. end - 1.
  void sample(int first, int end) {
    std::vector<LineStretch> stretches = stretchesOf(first, end);
    std::sort(stretches.begin(), stretches.end(), [](const LineStretch& a, const LineStretch& b) {
      return std::tie(a.v, a.u, a.order, a.from) < std::tie(b.v, b.u, b.order, b.from);
    });
    Covered covered;
    for (size_t i = 0; i < stretches.size(); ++i) {
      const LineStretch& s = stretches[i];
      if (i > 0 && (s.u != stretches[i - 1].u || s.v != stretches[i - 1].v)) covered.clear();
      takeAll(s, first);
      covered.add({s.from, s.to}, [&](double from, double to) { takeOwn(s, first, from, to); });
    }
  }

  void finish() {
    for (size_t order = 0; order < volumes_.size(); ++order) correct(order);
    share();
    std::sort(cells_.begin(), cells_.end(), [](const UnionCell& a, const UnionCell& b) { return a.cell < b.cell; });
    for (const UnionCell& c : cells_) settle(c);
    giveSlivers(slivers_, solid_);
  }

 private:
  std::vector<LineStretch> stretchesOf(int first, int end) const {
    Solid lines;  // the slab's lines are those through the cell centres of a finer grid
    lines.spacing_m = solid_.spacing_m / kLines;
    lines.origin_m = solid_.origin_m + Vector3d(0, 0, first * solid_.spacing_m);
    lines.cells = kLines * Vector3i(solid_.cells.x(), solid_.cells.y(), end - first);
    std::vector<LineStretch> out;
    const double most = solid_.cells.x();
    for (size_t order = 0; order < volumes_.size(); ++order) {
      for (const InsideStretch& s : insideStretches(volumes_[order].shell, lines, 0)) {
        const double from = std::clamp(s.from / kLines, 0.0, most), to = std::clamp(s.to / kLines, 0.0, most);
        if (from < to) out.push_back({s.column_u, s.column_v, order, from, to, s.winding});
      }
    }
    return out;
  }

  /// Calls visit(union cell, piece) for the surface cells that an interval of a line passes through.
  template <class Visit>
  void forEachCell(const LineStretch& s, int first_layer, double from, double to, Visit visit) {
    const int y = s.u / kLines, z = first_layer + s.v / kLines;
    const double low_y = static_cast<double>(s.u % kLines) / kLines - 0.5;
    const double low_z = static_cast<double>(s.v % kLines) / kLines - 0.5;
    const int last = std::min(static_cast<int>(to), solid_.cells.x() - 1);
    for (int x = static_cast<int>(from); x <= last; ++x) {
      const uint32_t known = union_of_[solid_.index(x, y, z)];
      if (known == 0) continue;
      const double middle = x + 0.5;
      const Vector3d low(std::max(from - middle, -0.5), low_y, low_z);
      const Vector3d high(std::min(to - middle, 0.5), low_y + 1.0 / kLines, low_z + 1.0 / kLines);
      visit(known - 1, boxFill(low, high));
    }
  }

  void takeAll(const LineStretch& s, int first_layer) {
    forEachCell(s, first_layer, s.from, s.to, [&](uint32_t at, const CellFill& piece) {
      const auto found = parts_[s.order].find(at);
      if (found == parts_[s.order].end()) return;
      PartCell& part = found->second;
      add(part.sampled, piece);
      part.is_plain = part.is_plain && s.winding != 0 && (part.winding == 0 || part.winding == s.winding);
      part.winding = s.winding;
    });
  }

  void takeOwn(const LineStretch& s, int first_layer, double from, double to) {
    forEachCell(s, first_layer, from, to, [&](uint32_t at, const CellFill& piece) {
      add(cells_[at].sampled, piece);
      const auto found = parts_[s.order].find(at);
      if (found != parts_[s.order].end()) found->second.own += piece.share;
      if (volumes_.size() > 1) addOwn(s.order, at, piece);
    });
  }

  void addOwn(size_t order, uint32_t at, const CellFill& piece, double times = 1) {
    add(own_[order].try_emplace(at, noFill()).first->second, piece, times);
  }

  void correct(size_t order) {
    const int facing = volumes_[order].shell.volume_m3 < 0 ? -1 : 1;
    for (const auto& [at, part] : parts_[order]) {
      CellFill missed = noFill();
      if (part.is_plain) {
        add(missed, part.exact, part.winding == 0 ? facing : part.winding);
        add(missed, part.sampled, -1);
      }
      const double seen = part.sampled.share > 0 ? part.own / part.sampled.share : 1;
      UnionCell& cell = cells_[at];
      add(cell.correction, missed, seen);
      if (volumes_.size() > 1) addOwn(order, at, missed, seen);
      const double share = part.sampled.share + missed.share;
      if (share <= cell.largest_share) continue;
      cell.largest_share = share;
      cell.largest_label = volumes_[order].part + 1;
    }
  }

  /// Records each part's contribution to cells that several parts share; before the cells are sorted.
  void share() {
    std::vector<PartFill> all;
    for (size_t order = 0; order < volumes_.size(); ++order) {
      const auto label = static_cast<uint16_t>(volumes_[order].part + 1);
      for (const auto& [at, fill] : own_[order])
        if (fill.share >= kLeastGap && isPossible(fill)) all.push_back({cells_[at].cell, label, fill});
    }
    std::sort(all.begin(), all.end(), [](const PartFill& a, const PartFill& b) {
      return std::tie(a.cell, a.label) < std::tie(b.cell, b.label);
    });
    for (size_t i = 0; i < all.size(); ++i) {
      const bool before = i > 0 && all[i - 1].cell == all[i].cell;
      const bool after = i + 1 < all.size() && all[i + 1].cell == all[i].cell;
      if (before || after) solid_.shared.push_back(all[i]);
    }
  }

  void settle(const UnionCell& c) {
    CellFill fill = c.sampled;
    add(fill, c.correction);
    if (!isPossible(fill)) fill = c.sampled;
    uint16_t& label = solid_.labels[c.cell];
    if (fill.share < kLeastShare) {
      label = 0;
      slivers_.push_back({c.cell, fill});
      return;
    }
    if (label == 0) label = c.largest_label;
    if (fill.share <= 1 - kLeastGap) solid_.partial.push_back({c.cell, fill});
  }

  const std::vector<Volume>& volumes_;
  Solid& solid_;
  std::vector<UnionCell> cells_;
  std::vector<PartialCell> slivers_;
  std::vector<std::unordered_map<uint32_t, PartCell>> parts_;  ///< by index into cells_, before they are sorted
  std::vector<std::unordered_map<uint32_t, CellFill>> own_;    ///< without smaller parts; empty if there is one part
  std::vector<uint32_t> union_of_;                             ///< [cells] 0, or 1 + index into cells_
};

}  // namespace

void fillByMoments(const std::vector<Volume>& volumes, Solid& solid, const Progress& progress) {
  const int layers = solid.cells.z();
  const double steps = 2.0 * static_cast<double>(volumes.size()) + layers;
  double done = 0;
  const auto advance = [&](int by) {
    done += by;
    if (progress) progress("voxelise", done / steps);
  };
  MomentFiller filler(volumes, solid);
  for (size_t order = 0; order < volumes.size(); ++order) {
    fillCentres(volumes[order], solid);
    advance(1);
    filler.addSurface(order);
    advance(1);
  }
  const int at_once = filler.layersAtOnce();
  for (int first = 0; first < layers; first += at_once) {
    const int end = std::min(layers, first + at_once);
    filler.sample(first, end);
    advance(end - first);
  }
  filler.finish();
}

}  // namespace viscera
