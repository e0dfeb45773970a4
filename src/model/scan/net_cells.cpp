// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/net_cells.h"

#include <algorithm>
#include <utility>

namespace viscera {
namespace {

// Corner c of a dual cell is the voxel at (c & 1, c >> 1 & 1, c >> 2). Pairs of neighbours have the numbers 4 axis +
// which.
constexpr int kPair[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                              {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
/// Corners around each face of a dual cell, and the pair between each and the next.
constexpr int kFaceCorner[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
constexpr int kFacePair[6][4] = {{4, 10, 6, 8},  {5, 11, 7, 9}, {0, 9, 2, 8},
                                 {1, 11, 3, 10}, {0, 5, 1, 4},  {2, 7, 3, 6}};
constexpr int kNoSheet = -1;

using Labels = std::array<uint8_t, 8>;
using Sheets = std::array<int, 12>;
using PairVertices = std::array<uint32_t, 12>;

void join(Sheets& sheets, int pair_a, int pair_b) {
  const int low = std::min(sheets[pair_a], sheets[pair_b]), high = std::max(sheets[pair_a], sheets[pair_b]);
  std::replace(sheets.begin(), sheets.end(), high, low);
}

/// Returns which pairs of a dual cell one sheet of the surface cuts: [pairs] the lowest pair of its sheet, or kNoSheet
/// where both voxels have the same label. A single vertex for all sheets of a cell would pinch walls of one and a half
/// voxels.
Sheets sheetsOf(const Labels& labels) {
  Sheets sheets;
  for (int p = 0; p < 12; ++p) sheets[p] = labels[kPair[p][0]] != labels[kPair[p][1]] ? p : kNoSheet;
  for (int f = 0; f < 6; ++f) {
    const int* pair = kFacePair[f];
    const auto label = [&](int c) { return labels[kFaceCorner[f][c]]; };
    const bool crossed = label(0) == label(2) && label(1) == label(3) && label(0) != label(1);
    if (crossed) {  // the larger label, tissue rather than outside, stays connected across the diagonal
      const int apart = label(0) < label(1) ? 0 : 1;
      join(sheets, pair[(apart + 3) % 4], pair[apart]);
      join(sheets, pair[apart + 1], pair[(apart + 2) % 4]);
      continue;
    }
    int first = kNoSheet;
    for (int c = 0; c < 4; ++c) {
      if (sheets[pair[c]] == kNoSheet) continue;
      if (first == kNoSheet) first = pair[c];
      join(sheets, first, pair[c]);
    }
  }
  return sheets;
}

/// Traversal of the volume slice by slice. Its voxels are counted from 1: a layer of label 0 surrounds them.
class CellWalk {
 public:
  CellWalk(const LabelVolume& volume, const Crossing& crossing)
      : volume_(volume),
        crossing_(crossing),
        size_(volume.frame.size),
        spacing_m_(volume.frame.spacing_m()),
        row_(size_.x() + 2),
        low_(static_cast<size_t>(row_) * (size_.y() + 2), 0),
        high_(low_.size(), 0),
        below_(low_.size(), kNone),
        here_(low_.size(), kNone) {}

  NetCells walk() {
    for (int k = 0; k <= size_.z(); ++k) {
      takeSlice(k + 1);
      makeVertices(k);
      makeQuads();
      low_.swap(high_);
      below_.swap(here_);
      vertices_below_.swap(vertices_here_);
    }
    return std::move(net_);
  }

 private:
  static constexpr uint32_t kNone = UINT32_MAX;

  void takeSlice(int k) {
    std::fill(high_.begin(), high_.end(), 0);
    if (k > size_.z()) return;
    const uint8_t* from = volume_.labels.data() + static_cast<size_t>(k - 1) * size_.x() * size_.y();
    for (int j = 1; j <= size_.y(); ++j, from += size_.x()) std::copy(from, from + size_.x(), &high_[at(1, j)]);
  }

  size_t at(int i, int j) const { return static_cast<size_t>(j) * row_ + i; }

  Labels labelsAround(size_t cell) const {
    return {low_[cell],  low_[cell + 1],  low_[cell + row_],  low_[cell + row_ + 1],
            high_[cell], high_[cell + 1], high_[cell + row_], high_[cell + row_ + 1]};
  }

  /// Makes the vertices of the dual cells between slices k and k + 1.
  void makeVertices(int k) {
    std::fill(here_.begin(), here_.end(), kNone);
    vertices_here_.clear();
    for (int j = 0; j <= size_.y(); ++j) {
      for (int i = 0; i <= size_.x(); ++i) {
        const Labels labels = labelsAround(at(i, j));
        if (std::all_of(labels.begin() + 1, labels.end(), [&](uint8_t l) { return l == labels[0]; })) continue;
        here_[at(i, j)] = static_cast<uint32_t>(vertices_here_.size());
        vertices_here_.push_back(verticesOf({i, j, k}, sheetsOf(labels)));
      }
    }
  }

  PairVertices verticesOf(const Vector3i& cell, const Sheets& sheets) {
    PairVertices vertices;
    vertices.fill(kNone);
    for (int p = 0; p < 12; ++p) {
      if (sheets[p] == kNoSheet) continue;
      if (sheets[p] != p) {
        vertices[p] = vertices[sheets[p]];
        continue;
      }
      vertices[p] = static_cast<uint32_t>(net_.positions_m.size());
      const Vector3d position = crossing_ ? meanCrossing(cell, sheets, p) : Vector3d::Constant(0.5);
      // Counted from the voxel, not from the layer around it: hence - 1.
      net_.positions_m.push_back((cell.cast<double>() + position - Vector3d::Ones()).cwiseProduct(spacing_m_));
    }
    return vertices;
  }

  Vector3d meanCrossing(const Vector3i& cell, const Sheets& sheets, int sheet) const {
    Vector3d sum = Vector3d::Zero();
    int count = 0;
    for (int p = sheet; p < 12; ++p) {
      if (sheets[p] != sheet) continue;
      const int lower = kPair[p][0];
      const Vector3i corner(lower & 1, lower >> 1 & 1, lower >> 2);
      Vector3d position = corner.cast<double>();
      position[p / 4] += crossing_(cell + corner - Vector3i::Ones(), p / 4);
      sum += position;
      ++count;
    }
    return sum / count;
  }

  /// Makes the quads between neighbours within the lower slice, and from it to the upper one.
  void makeQuads() {
    const size_t step[3] = {1, static_cast<size_t>(row_), 0};
    for (int j = 0; j <= size_.y(); ++j) {
      for (int i = 0; i <= size_.x(); ++i) {
        const size_t c = at(i, j);
        for (int axis = 0; axis < 2; ++axis) {
          if (low_[c] != low_[c + step[axis]]) addQuad(c, axis, {low_[c], low_[c + step[axis]]});
        }
        if (low_[c] != high_[c]) addQuad(c, 2, {low_[c], high_[c]});
      }
    }
  }

  /// @param c  the lower voxel of the pair, which is also the dual cell with this voxel as its lowest corner
  void addQuad(size_t c, int axis, const std::array<uint8_t, 2>& sides) {
    const size_t step[3] = {1, static_cast<size_t>(row_), 0};
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    constexpr int kBack[4][2] = {{1, 1}, {0, 1}, {0, 0}, {1, 0}};  // of the cells around the pair, along u and v
    std::array<uint32_t, 4> quad;
    for (int q = 0; q < 4; ++q) {
      const auto [back_u, back_v] = std::pair(kBack[q][0], kBack[q][1]);
      const bool is_below = (u == 2 && back_u) || (v == 2 && back_v);
      const size_t cell = c - (u == 2 ? 0 : back_u * step[u]) - (v == 2 ? 0 : back_v * step[v]);
      const int lower_corner = back_u << u | back_v << v;
      quad[q] = is_below ? vertices_below_[below_[cell]][pairOf(lower_corner, axis)]
                         : vertices_here_[here_[cell]][pairOf(lower_corner, axis)];
    }
    net_.quads.push_back(quad);
    net_.sides.push_back(sides);
  }

  static int pairOf(int lower_corner, int axis) {
    if (axis == 0) return lower_corner >> 1;
    if (axis == 1) return 4 + ((lower_corner & 1) | (lower_corner >> 1 & 2));
    return 8 + lower_corner;
  }

  const LabelVolume& volume_;
  const Crossing& crossing_;
  const Vector3i size_;
  const Vector3d spacing_m_;
  const int row_;
  std::vector<uint8_t> low_, high_;     ///< labels of two slices
  std::vector<uint32_t> below_, here_;  ///< [dual cells of a layer] index into vertices_*_, or kNone
  std::vector<PairVertices> vertices_below_, vertices_here_;
  NetCells net_;
};

}  // namespace

NetCells netCells(const LabelVolume& volume, const Crossing& crossing) {
  return CellWalk(volume, crossing).walk();
}

}  // namespace viscera
