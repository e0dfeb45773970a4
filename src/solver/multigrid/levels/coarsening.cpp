// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/levels/coarsening.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace viscera::multigrid {

namespace {

constexpr int kCorners = 8;

using Weights = Eigen::Matrix<float, kCorners, Eigen::Dynamic>;  // of coarse nodes in an element's corners
using Square = Eigen::MatrixXf;

/// A share of the matrix.
struct Part {
  std::vector<int32_t> nodes;  ///< -1: none
  Square matrix;               ///< three rows and columns a node
};

Square projected(const ElementMatrix& a, const Weights& w) {
  const auto count = static_cast<int>(w.cols());
  Eigen::Matrix<float, 24, Eigen::Dynamic> half_way(24, 3 * count);
  half_way.setZero();
  Square out = Square::Zero(3 * count, 3 * count);
  for (int f = 0; f < kCorners; ++f) {
    for (int c = 0; c < count; ++c) {
      if (w(f, c) != 0) half_way.middleCols<3>(3 * c) += w(f, c) * a.middleCols<3>(3 * f);
    }
  }
  for (int f = 0; f < kCorners; ++f) {
    for (int c = 0; c < count; ++c) {
      if (w(f, c) != 0) out.middleRows<3>(3 * c) += w(f, c) * half_way.middleRows<3>(3 * f);
    }
  }
  return out;
}

BlockMatrix assembled(const std::vector<Part>& parts, size_t rows) {
  std::vector<std::vector<uint32_t>> beside(rows);
  for (const Part& part : parts) {
    for (const int32_t a : part.nodes) {
      for (const int32_t b : part.nodes) {
        if (a >= 0 && b >= 0) beside[static_cast<size_t>(a)].push_back(static_cast<uint32_t>(b));
      }
    }
  }
  BlockMatrix out;
  for (std::vector<uint32_t>& row : beside) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    out.columns.insert(out.columns.end(), row.begin(), row.end());
    out.starts.push_back(static_cast<uint32_t>(out.columns.size()));
  }
  out.numbers.assign(BlockMatrix::kNumbers * out.columns.size(), 0);
  for (const Part& part : parts) {
    for (size_t a = 0; a < part.nodes.size(); ++a) {
      for (size_t b = 0; b < part.nodes.size(); ++b) {
        if (part.nodes[a] < 0 || part.nodes[b] < 0) continue;
        float* const to =
            out.at(out.entryOf(static_cast<uint32_t>(part.nodes[a]), static_cast<uint32_t>(part.nodes[b])));
        const auto block = part.matrix.block<3, 3>(static_cast<int>(3 * a), static_cast<int>(3 * b));
        for (int j = 0; j < 3; ++j)
          for (int i = 0; i < 3; ++i) to[4 * j + i] += block(i, j);
      }
    }
  }
  return out;
}

/// P^T A P of the lattice: elements that lie in one coarse cell, and take from the same coarse nodes at its corners,
/// make one part.
class LatticeProduct {
 public:
  LatticeProduct(const Elements& lattice, const Transfer& transfer) : lattice_(lattice), transfer_(transfer) {}

  std::vector<Part> run() {
    for (const uint32_t e : byCoarseCell()) addElement(lattice_.elements[e]);
    return std::move(parts_);
  }

 private:
  static Vector3i cellOf(const Element& element) {
    return {element.at.x() / 2, element.at.y() / 2, element.at.z() / 2};
  }

  std::vector<uint32_t> byCoarseCell() const {
    std::vector<uint32_t> order(lattice_.elements.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](uint32_t e) {
      const Vector3i cell = cellOf(lattice_.elements[e]);
      return std::make_tuple(lattice_.elements[e].body, cell.z(), cell.y(), cell.x());
    };
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    return order;
  }

  void addElement(const Element& element) {
    Weights w = Weights::Zero(kCorners, kCorners);
    std::vector<int32_t> corners(kCorners, -1);
    bool whole = true;
    for (int f = 0; f < kCorners; ++f) {
      const int32_t node = element.nodes[static_cast<size_t>(f)];
      whole = whole && node >= 0 && lattice_.free[static_cast<size_t>(node)] != 0;
      if (node >= 0 && !takeByCorner(element, f, w, corners)) return addApart(element);
    }
    if (!(parts_.size() > first_of_cell_ && isSameCell(element) && fits(corners))) beginPart(element);
    Part& part = parts_.back();
    for (size_t c = 0; c < kCorners; ++c) part.nodes[c] = std::max(part.nodes[c], corners[c]);
    if (!whole || lattice_.matrices.size() == lattice_.elements.size()) {
      part.matrix += projected(lattice_.matrices[element.matrix], w);
      return;
    }
    const Vector3i in = element.at - 2 * cellOf(element);
    const uint32_t position = static_cast<uint32_t>(in.x() + 2 * in.y() + 4 * in.z());
    const auto [known, is_new] = known_.emplace(kCorners * element.matrix + position, Square());
    if (is_new) known->second = projected(lattice_.matrices[element.matrix], w);
    part.matrix += known->second;
  }

  /// What one of an element's nodes takes, by corner of the coarse cell. @return false: two nodes take from different
  /// coarse nodes at one corner
  bool takeByCorner(const Element& element, int f, Weights& w, std::vector<int32_t>& corners) const {
    const auto node = static_cast<size_t>(element.nodes[static_cast<size_t>(f)]);
    const Vector3i base = cellOf(element), &at = lattice_.nodes.at[node];
    uint32_t entry = transfer_.starts[node];
    if (entry == transfer_.starts[node + 1]) return true;
    for (int z = at.z() / 2; z <= (at.z() + 1) / 2; ++z) {
      for (int y = at.y() / 2; y <= (at.y() + 1) / 2; ++y) {
        for (int x = at.x() / 2; x <= (at.x() + 1) / 2; ++x, ++entry) {
          const int c = (x - base.x()) + 2 * (y - base.y()) + 4 * (z - base.z());
          const auto parent = static_cast<int32_t>(transfer_.parents[entry]);
          int32_t& known = corners[static_cast<size_t>(c)];
          if (known >= 0 && known != parent) return false;
          known = parent;
          w(f, c) = transfer_.weights[entry];
        }
      }
    }
    return true;
  }

  bool isSameCell(const Element& element) const { return element.body == body_ && cellOf(element) == cell_; }
  bool fits(const std::vector<int32_t>& corners) const {
    for (size_t c = 0; c < kCorners; ++c) {
      const int32_t known = parts_.back().nodes[c];
      if (known >= 0 && corners[c] >= 0 && known != corners[c]) return false;
    }
    return true;
  }
  void beginPart(const Element& element) {
    body_ = element.body;
    cell_ = cellOf(element);
    parts_.push_back({std::vector<int32_t>(kCorners, -1), Square::Zero(3 * kCorners, 3 * kCorners)});
  }

  /// An element at the front of a cut.
  void addApart(const Element& element) {
    Part part;
    for (const int32_t node : element.nodes) {
      if (node < 0) continue;
      const auto n = static_cast<size_t>(node);
      for (uint32_t i = transfer_.starts[n]; i < transfer_.starts[n + 1]; ++i)
        part.nodes.push_back(static_cast<int32_t>(transfer_.parents[i]));
    }
    std::sort(part.nodes.begin(), part.nodes.end());
    part.nodes.erase(std::unique(part.nodes.begin(), part.nodes.end()), part.nodes.end());
    Weights w = Weights::Zero(kCorners, static_cast<int>(part.nodes.size()));
    for (int f = 0; f < kCorners; ++f) {
      if (element.nodes[static_cast<size_t>(f)] < 0) continue;
      const auto n = static_cast<size_t>(element.nodes[static_cast<size_t>(f)]);
      for (uint32_t i = transfer_.starts[n]; i < transfer_.starts[n + 1]; ++i) {
        const auto at =
            std::lower_bound(part.nodes.begin(), part.nodes.end(), static_cast<int32_t>(transfer_.parents[i]));
        w(f, static_cast<int>(at - part.nodes.begin())) += transfer_.weights[i];
      }
    }
    part.matrix = projected(lattice_.matrices[element.matrix], w);
    parts_.push_back(std::move(part));
    first_of_cell_ = parts_.size();
  }

  const Elements& lattice_;
  const Transfer& transfer_;
  std::vector<Part> parts_;
  size_t first_of_cell_ = 0;  ///< parts before it are closed
  uint32_t body_ = 0;
  Vector3i cell_ = Vector3i::Zero();
  std::map<uint32_t, Square> known_;
};

/// Which corners of an element pull at each other: bit 8 a + b.
uint64_t pullsOf(const ElementMatrix& matrix) {
  uint64_t out = 0;
  for (int a = 0; a < kCorners; ++a)
    for (int b = 0; b < kCorners; ++b)
      if (!matrix.block<3, 3>(3 * a, 3 * b).isZero(0)) out |= uint64_t{1} << (kCorners * a + b);
  return out;
}

/// y += w B.
void addBlock(float w, const float* block, float* to) {
  for (size_t i = 0; i < BlockMatrix::kNumbers; ++i) to[i] += w * block[i];
}

/// P^T A P, row by row (F. G. Gustavson, ACM Trans. Math. Softw. 4, 1978).
BlockMatrix product(const BlockMatrix& a, const Transfer& t) {
  const size_t rows = t.coarse_starts.size() - 1;
  BlockMatrix out;
  std::vector<int32_t> at(rows, -1);
  AlignedVector<float> sums;
  std::vector<uint32_t> columns;
  for (size_t row = 0; row < rows; ++row) {
    columns.clear();
    sums.clear();
    for (uint32_t i = t.coarse_starts[row]; i < t.coarse_starts[row + 1]; ++i) {
      const uint32_t child = t.children[i];
      for (uint32_t j = a.starts[child]; j < a.starts[child + 1]; ++j) {
        for (uint32_t k = t.starts[a.columns[j]]; k < t.starts[a.columns[j] + 1]; ++k) {
          int32_t& place = at[t.parents[k]];
          if (place < 0) {
            place = static_cast<int32_t>(columns.size());
            columns.push_back(t.parents[k]);
            sums.resize(sums.size() + BlockMatrix::kNumbers, 0);
          }
          addBlock(t.coarse_weights[i] * t.weights[k], a.at(j),
                   &sums[BlockMatrix::kNumbers * static_cast<size_t>(place)]);
        }
      }
    }
    std::sort(columns.begin(), columns.end());
    for (const uint32_t column : columns) {
      const float* const block = &sums[BlockMatrix::kNumbers * static_cast<size_t>(at[column])];
      at[column] = -1;
      if (std::all_of(block, block + BlockMatrix::kNumbers, [](float each) { return each == 0; })) continue;
      out.columns.push_back(column);
      out.numbers.insert(out.numbers.end(), block, block + BlockMatrix::kNumbers);
    }
    out.starts.push_back(static_cast<uint32_t>(out.columns.size()));
  }
  return out;
}

/// Which of the 27 nodes in a cube around a node another one is: a bit.
uint32_t bitOf(const Vector3i& offset) {
  return 1u << (offset.x() + 1 + 3 * (offset.y() + 1) + 9 * (offset.z() + 1));
}

std::vector<Link> linksOf(const Elements& lattice) {
  std::vector<uint64_t> pulls;
  for (const ElementMatrix& matrix : lattice.matrices) pulls.push_back(pullsOf(matrix));
  std::vector<uint32_t> known(lattice.nodes.at.size(), 0);  // a link may be in several elements
  std::vector<Link> out;
  for (const Element& element : lattice.elements) {
    for (int a = 0; a < kCorners; ++a) {
      for (int b = a + 1; b < kCorners; ++b) {
        if (element.nodes[static_cast<size_t>(a)] < 0 || element.nodes[static_cast<size_t>(b)] < 0) continue;
        if (!(pulls[element.matrix] >> (kCorners * a + b) & 1)) continue;
        const auto i = static_cast<uint32_t>(element.nodes[static_cast<size_t>(a)]);
        const auto j = static_cast<uint32_t>(element.nodes[static_cast<size_t>(b)]);
        const uint32_t bit = bitOf(lattice.nodes.at[j] - lattice.nodes.at[i]);
        if (known[i] & bit) continue;
        known[i] |= bit;
        out.emplace_back(i, j);
      }
    }
  }
  return out;
}

/// Nodes at one place lie on the two sides of a cut: what couples them is beyond its front.
std::vector<Link> linksOf(const LevelNodes& nodes, const BlockMatrix& matrix) {
  std::vector<Link> out;
  for (uint32_t row = 0; row < matrix.rows(); ++row) {
    for (uint32_t i = matrix.starts[row]; i < matrix.starts[row + 1]; ++i) {
      const uint32_t column = matrix.columns[i];
      if (column > row && nodes.at[row] != nodes.at[column] && !matrix.isZero(i)) out.emplace_back(row, column);
    }
  }
  return out;
}

/// Who takes: nodes of elements that move.
std::vector<uint8_t> takersOf(const Elements& lattice) {
  std::vector<uint8_t> out(lattice.nodes.at.size(), 0);
  for (const Element& element : lattice.elements) {
    for (const int32_t node : element.nodes) {
      if (node >= 0) out[static_cast<size_t>(node)] = lattice.free[static_cast<size_t>(node)];
    }
  }
  return out;
}

}  // namespace

Coarsening coarsened(const Elements& lattice) {
  Interpolation interpolation(lattice.nodes, takersOf(lattice), linksOf(lattice));
  const size_t count = interpolation.coarse.at.size();
  BlockMatrix matrix = assembled(LatticeProduct(lattice, interpolation.transfer).run(), count);
  return {std::move(interpolation.coarse), std::move(interpolation.transfer), std::move(matrix)};
}

Coarsening coarsened(const LevelNodes& nodes, const BlockMatrix& matrix) {
  Interpolation interpolation(nodes, std::vector<uint8_t>(nodes.at.size(), 1), linksOf(nodes, matrix));
  BlockMatrix coarse = product(matrix, interpolation.transfer);
  return {std::move(interpolation.coarse), std::move(interpolation.transfer), std::move(coarse)};
}

}  // namespace viscera::multigrid
