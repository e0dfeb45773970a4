// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/pieces.h"

#include <algorithm>
#include <utility>

#include "math/union_find.h"

namespace viscera {
namespace {

struct Run {
  int begin, end;  ///< along i, exclusive end
  uint32_t piece;
};

/// Runs of a slice, row by row.
struct SliceRuns {
  std::vector<Run> runs;
  std::vector<size_t> first;  ///< [rows + 1]
};

/// Visits all runs in order. `piece_of(earlier runs that touch it)` gives the piece of a run.
template <typename PieceOf, typename Visit>
void walk(const Mask& mask, uint8_t value, PieceOf&& piece_of, Visit&& visit) {
  SliceRuns now, before;
  before.first.assign(static_cast<size_t>(mask.size.y()) + 1, 0);
  std::vector<uint32_t> touched;
  const auto touching = [&](const SliceRuns& slice, size_t row, const Run& run) {
    const auto end = slice.runs.begin() + static_cast<std::ptrdiff_t>(slice.first[row + 1]);
    auto other = std::lower_bound(slice.runs.begin() + static_cast<std::ptrdiff_t>(slice.first[row]), end, run.begin,
                                  [](const Run& r, int begin) { return r.end <= begin; });
    for (; other != end && other->begin < run.end; ++other) touched.push_back(other->piece);
  };
  for (int k = 0; k < mask.size.z(); ++k) {
    now.runs.clear();
    now.first.assign(1, 0);
    for (int j = 0; j < mask.size.y(); ++j) {
      const uint8_t* row = mask.voxels.data() + mask.at(0, j, k);
      for (int i = 0; i < mask.size.x();) {
        if (row[i] != value) {
          ++i;
          continue;
        }
        Run run{i, i, 0};
        while (run.end < mask.size.x() && row[run.end] == value) ++run.end;
        i = run.end;
        touched.clear();
        if (j > 0) touching(now, static_cast<size_t>(j) - 1, run);
        touching(before, static_cast<size_t>(j), run);
        run.piece = piece_of(touched);
        visit(run, j, k);
        now.runs.push_back(run);
      }
      now.first.push_back(now.runs.size());
    }
    std::swap(now, before);
  }
}

/// Transform that computes the squared distance to the nearest marked sample along a line, from the squared distances
/// across it (Felzenszwalb and Huttenlocher).
class LineDistance {
 public:
  explicit LineDistance(size_t most) : value_(most), position_(most), from_(most + 1) {}
  /// @param line  squared distances, `step` apart; replaced by the result
  void run(float* line, size_t count, size_t step, double spacing) {
    const double square = spacing * spacing;
    size_t top = 0;
    bool any = false;
    for (size_t n = 0; n < count; ++n) {
      value_[n] = line[n * step] / square;
      if (line[n * step] >= kFar) continue;
      double cross = -kFar;
      while (any) {
        const auto p = static_cast<double>(position_[top]), q = static_cast<double>(n);
        cross = (value_[n] + q * q - value_[position_[top]] - p * p) / (2 * (q - p));
        if (cross > from_[top]) break;
        cross = -kFar;
        if (top == 0)
          any = false;
        else
          --top;
      }
      top = any ? top + 1 : 0;
      any = true;
      position_[top] = n;
      from_[top] = cross;
    }
    if (!any) return;
    size_t at = 0;
    for (size_t n = 0; n < count; ++n) {
      while (at < top && from_[at + 1] < static_cast<double>(n)) ++at;
      const double d = static_cast<double>(n) - static_cast<double>(position_[at]);
      line[n * step] = static_cast<float>(std::min<double>(square * (d * d + value_[position_[at]]), kFar));
    }
  }
  static constexpr float kFar = 1e12F;

 private:
  std::vector<double> value_;
  std::vector<size_t> position_;
  std::vector<double> from_;
};

}  // namespace

Pieces::Pieces(const Mask& mask, uint8_t value) : value_(value) {
  UnionFind joined;
  const auto piece_of = [&](const std::vector<uint32_t>& touched) {
    if (touched.empty()) {
      voxels_.push_back(0);
      at_border_.push_back(0);
      return joined.add();
    }
    uint32_t piece = touched[0];
    for (const uint32_t other : touched) piece = joined.unite(piece, other);
    return piece;
  };
  walk(mask, value, piece_of, [&](const Run& run, int j, int k) {
    voxels_[run.piece] += static_cast<uint64_t>(run.end - run.begin);
    const bool border = run.begin == 0 || run.end == mask.size.x() || j == 0 || j == mask.size.y() - 1 || k == 0 ||
                        k == mask.size.z() - 1;
    if (border) at_border_[run.piece] = 1;
  });
  root_ = std::move(joined).all();
  for (uint32_t piece = 0; piece < root_.size(); ++piece) {
    const uint32_t root = root_[piece];
    if (root == piece) continue;
    voxels_[root] += std::exchange(voxels_[piece], 0);
    at_border_[root] |= at_border_[piece];
  }
}

size_t Pieces::count() const {
  return static_cast<size_t>(std::count_if(voxels_.begin(), voxels_.end(), [](uint64_t n) { return n > 0; }));
}

void Pieces::assign(Mask& mask, const std::function<bool(uint32_t piece)>& which, uint8_t value) const {
  uint32_t next = 0;  // numbered as in the constructor
  const auto piece_of = [&](const std::vector<uint32_t>& touched) {
    return touched.empty() ? root_[next++] : touched[0];
  };
  std::vector<uint8_t> chosen(root_.size());
  for (uint32_t piece = 0; piece < root_.size(); ++piece) chosen[piece] = root_[piece] == piece && which(piece);
  walk(mask, value_, piece_of, [&](const Run& run, int j, int k) {
    if (!chosen[run.piece]) return;
    const auto row = mask.voxels.begin() + static_cast<std::ptrdiff_t>(mask.at(0, j, k));
    std::fill(row + run.begin, row + run.end, value);
  });
}

void grow(Mask& mask, uint8_t value, const Vector3d& spacing, double distance) {
  const auto nx = static_cast<size_t>(mask.size.x()), ny = static_cast<size_t>(mask.size.y());
  const int reach = static_cast<int>(std::min<double>(distance / spacing.z(), mask.size.z()));
  const size_t ring = 2 * static_cast<size_t>(reach) + 1;  // number of slices with distances in memory
  std::vector<std::vector<float>> near(ring);
  LineDistance line(std::max(nx, ny));
  const auto measure = [&](int k) {
    std::vector<float>& d = near[static_cast<size_t>(k) % ring];
    d.resize(nx * ny);
    const uint8_t* slice = mask.voxels.data() + mask.at(0, 0, k);
    for (size_t n = 0; n < nx * ny; ++n) d[n] = slice[n] == value ? 0.0F : LineDistance::kFar;
    for (size_t j = 0; j < ny; ++j) line.run(d.data() + j * nx, nx, 1, spacing.x());
    for (size_t i = 0; i < nx; ++i) line.run(d.data() + i, ny, nx, spacing.y());
  };
  const double most = distance * distance * (1 + 1e-6);  // float32: includes voxels at exactly this distance
  for (int k = 0; k < std::min(reach, mask.size.z()); ++k) measure(k);
  for (int k = 0; k < mask.size.z(); ++k) {
    if (k + reach < mask.size.z()) measure(k + reach);
    uint8_t* slice = mask.voxels.data() + mask.at(0, 0, k);
    for (int other = std::max(0, k - reach); other <= std::min(mask.size.z() - 1, k + reach); ++other) {
      const double across = (other - k) * spacing.z(), left = most - across * across;
      const std::vector<float>& d = near[static_cast<size_t>(other) % ring];
      for (size_t n = 0; n < nx * ny; ++n)
        if (d[n] <= left) slice[n] = value;
    }
  }
}

}  // namespace viscera
