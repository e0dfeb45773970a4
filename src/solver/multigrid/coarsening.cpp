// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "solver/multigrid/elements.h"

namespace viscera::multigrid {

namespace {

constexpr int kCorners = 8;

/// Sets of numbers that are joined two by two.
class Joined {
 public:
  explicit Joined(size_t count) : of_(count) { std::iota(of_.begin(), of_.end(), 0u); }
  uint32_t find(uint32_t i) {
    while (of_[i] != i) i = of_[i] = of_[of_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) {
    a = find(a);
    b = find(b);
    of_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<uint32_t> of_;
};

/// Coordinates are never negative.
int half(int i) {
  return i / 2;
}

/// Share of coarse corner c in a place of its cell, in halves of its edges.
float weightOf(const Vector3i& place, int c) {
  float out = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const int at = 2 * (c >> axis & 1) - place[axis];  // 0 there, 1 half way
    out *= at == 0 ? 1.0f : at == 1 || at == -1 ? 0.5f : 0.0f;
  }
  return out;
}

using Weights = Eigen::Matrix<float, kCorners, kCorners>;  // corners of the element, of the coarse cell

class Merger {
 public:
  explicit Merger(const Elements& fine) : fine_(fine), piece_(fine.elements.size()) {}

  Coarsening run() {
    groupCells();
    joinPieces();
    joinCorners();
    numberNodes();
    for (size_t e = 0; e < fine_.elements.size(); ++e) addMatrix(e);
    writeTransfer();
    return std::move(out_);
  }

 private:
  /// Elements by the coarse cell that they lie in, in the order z, y, x.
  void groupCells() {
    order_.resize(fine_.elements.size());
    std::iota(order_.begin(), order_.end(), 0u);
    const auto key = [&](uint32_t e) {
      const Element& element = fine_.elements[e];
      return std::make_tuple(element.body, half(element.at.z()), half(element.at.y()), half(element.at.x()));
    };
    std::stable_sort(order_.begin(), order_.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    for (size_t i = 0; i < order_.size(); ++i) {
      if (i == 0 || key(order_[i]) != key(order_[i - 1])) groups_.push_back(i);
    }
    groups_.push_back(order_.size());
  }

  /// Elements of a group that share a node are one coarse element.
  void joinPieces() {
    std::vector<std::pair<int32_t, uint32_t>> seen;  // node, element of the group
    for (size_t g = 0; g + 1 < groups_.size(); ++g) {
      const size_t first = groups_[g], count = groups_[g + 1] - first;
      Joined joined(count);
      seen.clear();
      for (size_t i = 0; i < count; ++i) {
        for (const int32_t node : fine_.elements[order_[first + i]].nodes) {
          if (node >= 0) seen.emplace_back(node, static_cast<uint32_t>(i));
        }
      }
      std::sort(seen.begin(), seen.end());
      for (size_t i = 1; i < seen.size(); ++i) {
        if (seen[i].first == seen[i - 1].first) joined.join(seen[i].second, seen[i - 1].second);
      }
      std::map<uint32_t, uint32_t> number;
      for (uint32_t i = 0; i < count; ++i) {
        const auto [at, is_new] = number.emplace(joined.find(i), static_cast<uint32_t>(out_.coarse.elements.size()));
        piece_[order_[first + i]] = at->second;
        if (is_new) addElement(fine_.elements[order_[first + i]]);
      }
    }
  }

  void addElement(const Element& of) {
    Element element;
    element.at = {half(of.at.x()), half(of.at.y()), half(of.at.z())};
    element.body = of.body;
    element.matrix = static_cast<uint32_t>(out_.coarse.elements.size());
    out_.coarse.elements.push_back(element);
  }

  /// Place of a node within a coarse cell, in halves of its edges.
  Vector3i placeIn(const Element& coarse, int32_t node) const {
    return fine_.node_at[static_cast<size_t>(node)] - 2 * coarse.at;
  }
  bool takes(int32_t node) const { return node >= 0 && fine_.node_free[static_cast<size_t>(node)]; }

  /// Corners at one place from which some node takes are one coarse node.
  void joinCorners() {
    const size_t corners = kCorners * out_.coarse.elements.size();
    Joined joined(corners);
    used_.assign(corners, 0);
    parents_.assign(fine_.node_at.size(), {-1, -1, -1, -1, -1, -1, -1, -1});
    for (size_t e = 0; e < fine_.elements.size(); ++e) {
      const Element& coarse = out_.coarse.elements[piece_[e]];
      for (const int32_t node : fine_.elements[e].nodes) {
        if (!takes(node)) continue;
        const Vector3i place = placeIn(coarse, node);
        for (int c = 0; c < kCorners; ++c) {
          if (weightOf(place, c) == 0) continue;
          const uint32_t corner = kCorners * piece_[e] + static_cast<uint32_t>(c);
          used_[corner] = 1;
          int32_t& known = parents_[static_cast<size_t>(node)][upperOf(coarse, node, c)];
          if (known >= 0) joined.join(static_cast<uint32_t>(known), corner);
          known = static_cast<int32_t>(corner);
        }
      }
    }
    node_of_.resize(corners);
    for (uint32_t i = 0; i < corners; ++i) node_of_[i] = static_cast<int32_t>(joined.find(i));
  }

  /// Which of a node's parents a corner is: bit per axis, set where it is the upper one of two.
  size_t upperOf(const Element& coarse, int32_t node, int c) const {
    const Vector3i& at = fine_.node_at[static_cast<size_t>(node)];
    size_t out = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (coarse.at[axis] + (c >> axis & 1) > half(at[axis])) out |= size_t{1} << axis;
    }
    return out;
  }

  void numberNodes() {
    std::vector<int32_t> number(node_of_.size(), -1);
    for (size_t i = 0; i < node_of_.size(); ++i) {
      if (!used_[i]) {
        node_of_[i] = -1;
        continue;
      }
      int32_t& mine = number[static_cast<size_t>(node_of_[i])];
      Element& element = out_.coarse.elements[i / kCorners];
      const int c = static_cast<int>(i % kCorners);
      if (mine < 0) {
        mine = static_cast<int32_t>(out_.coarse.node_at.size());
        out_.coarse.node_at.push_back(element.at + Vector3i(c & 1, c >> 1 & 1, c >> 2));
        out_.coarse.node_body.push_back(element.body);
        out_.coarse.node_free.push_back(1);
      }
      node_of_[i] = mine;
    }
    for (size_t i = 0; i < node_of_.size(); ++i) out_.coarse.elements[i / kCorners].nodes[i % kCorners] = node_of_[i];
    out_.coarse.matrices.assign(out_.coarse.elements.size(), ElementMatrix::Zero());
  }

  /// Adds P^T A P of an element to that of its coarse one.
  void addMatrix(size_t e) {
    const Element &element = fine_.elements[e], &coarse = out_.coarse.elements[piece_[e]];
    Weights w = Weights::Zero();
    bool whole = true;
    for (int f = 0; f < kCorners; ++f) {
      const int32_t node = element.nodes[static_cast<size_t>(f)];
      whole = whole && takes(node);
      if (!takes(node)) continue;
      const Vector3i place = placeIn(coarse, node);
      for (int c = 0; c < kCorners; ++c) w(f, c) = weightOf(place, c);
    }
    const Vector3i in = element.at - 2 * coarse.at;
    const uint32_t position = static_cast<uint32_t>(in.x() + 2 * in.y() + 4 * in.z());
    ElementMatrix& sum = out_.coarse.matrices[coarse.matrix];
    if (!whole || fine_.matrices.size() == fine_.elements.size()) {
      sum += projected(fine_.matrices[element.matrix], w);
      return;
    }
    const auto [known, is_new] = known_.emplace(kCorners * element.matrix + position, ElementMatrix());
    if (is_new) known->second = projected(fine_.matrices[element.matrix], w);
    sum += known->second;
  }

  static ElementMatrix projected(const ElementMatrix& a, const Weights& w) {
    ElementMatrix half_way = ElementMatrix::Zero(), out = ElementMatrix::Zero();
    for (int f = 0; f < kCorners; ++f) {
      for (int c = 0; c < kCorners; ++c) {
        if (w(f, c) != 0) half_way.middleCols<3>(3 * c) += w(f, c) * a.middleCols<3>(3 * f);
      }
    }
    for (int f = 0; f < kCorners; ++f) {
      for (int c = 0; c < kCorners; ++c) {
        if (w(f, c) != 0) out.middleRows<3>(3 * c) += w(f, c) * half_way.middleRows<3>(3 * f);
      }
    }
    return out;
  }

  void writeTransfer() {
    Transfer& t = out_.transfer;
    t.coarse_starts.assign(out_.coarse.node_at.size() + 1, 0);
    t.starts.push_back(0);
    for (size_t node = 0; node < parents_.size(); ++node) {
      const Vector3i& at = fine_.node_at[node];
      const int odd = (at.x() & 1) + (at.y() & 1) + (at.z() & 1);
      for (const int32_t corner : parents_[node]) {
        if (corner < 0) continue;
        t.parents.push_back(static_cast<uint32_t>(node_of_[static_cast<size_t>(corner)]));
        t.weights.push_back(1.0f / static_cast<float>(1 << odd));
        ++t.coarse_starts[t.parents.back() + 1];
      }
      t.starts.push_back(static_cast<uint32_t>(t.parents.size()));
    }
    std::partial_sum(t.coarse_starts.begin(), t.coarse_starts.end(), t.coarse_starts.begin());
    std::vector<uint32_t> next(t.coarse_starts.begin(), t.coarse_starts.end() - 1);
    t.children.resize(t.parents.size());
    t.coarse_weights.resize(t.parents.size());
    for (uint32_t node = 0; node < parents_.size(); ++node) {
      for (uint32_t i = t.starts[node]; i < t.starts[node + 1]; ++i) {
        const uint32_t to = next[t.parents[i]]++;
        t.children[to] = node;
        t.coarse_weights[to] = t.weights[i];
      }
    }
  }

  const Elements& fine_;
  std::vector<uint32_t> order_;
  std::vector<size_t> groups_;                   ///< [coarse cells + 1] into order_
  std::vector<uint32_t> piece_;                  ///< [elements] coarse element
  std::vector<uint8_t> used_;                    ///< [8 * coarse elements] some node takes from the corner
  std::vector<int32_t> node_of_;                 ///< [8 * coarse elements] coarse node
  std::vector<std::array<int32_t, 8>> parents_;  ///< [nodes] corners that it takes from
  std::map<uint32_t, ElementMatrix, std::less<uint32_t>,
           Eigen::aligned_allocator<std::pair<const uint32_t, ElementMatrix>>>
      known_;
  Coarsening out_;
};

}  // namespace

Coarsening coarsened(const Elements& fine) {
  return Merger(fine).run();
}

}  // namespace viscera::multigrid
