// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace viscera {

/// Disjoint sets of the numbers 0 to n - 1. Each set is represented by its smallest member. Paths are halved, so that m
/// calls take O(m log n).
class UnionFind {
 public:
  /// Makes n numbers, each a set of its own.
  explicit UnionFind(size_t n = 0) : parents_(n) { std::iota(parents_.begin(), parents_.end(), 0U); }

  /// Adds the next number as a set of its own, and returns it.
  uint32_t add() {
    parents_.push_back(static_cast<uint32_t>(parents_.size()));
    return parents_.back();
  }
  /// Returns the smallest member of the set of `member`, which must be below size().
  uint32_t find(uint32_t member) {
    while (parents_[member] != member) member = parents_[member] = parents_[parents_[member]];
    return member;
  }
  /// Unites the sets of two members, and returns the smallest member of the result.
  uint32_t unite(uint32_t a, uint32_t b) {
    a = find(a);
    b = find(b);
    return parents_[std::max(a, b)] = std::min(a, b);
  }
  /// Returns the smallest member of each number's set [size()].
  std::vector<uint32_t> all() && {
    for (uint32_t& parent : parents_) parent = parents_[parent];  // parents are smaller, so they are final
    return std::move(parents_);
  }
  size_t size() const { return parents_.size(); }

 private:
  std::vector<uint32_t> parents_;
};

}  // namespace viscera
