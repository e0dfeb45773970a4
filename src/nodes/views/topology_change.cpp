// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/topology_change.h"

#include <algorithm>
#include <optional>
#include <unordered_map>

namespace viscera::nodes {
namespace {

constexpr size_t kAhead = 96;  // triangles; a blade changes some tens of neighbouring ones per tick

/// Two lists that are traversed together.
class Walk {
 public:
  Walk(const std::vector<uint32_t>& before, const std::vector<uint32_t>& after) : before_(before), after_(after) {}

  TriangleEdits edits() {
    while (i_ < count(before_) || j_ < count(after_)) {
      uint32_t kept = 0;
      while (same(i_, j_)) {
        ++i_;
        ++j_;
        ++kept;
      }
      if (i_ == count(before_) && j_ == count(after_)) break;
      replace(kept);
    }
    return out_;
  }

 private:
  static size_t count(const std::vector<uint32_t>& triangles) { return triangles.size() / 3; }
  bool same(size_t i, size_t j) const {
    return i < count(before_) && j < count(after_) && std::equal(&before_[3 * i], &before_[3 * i] + 3, &after_[3 * j]);
  }
  struct Ahead {
    size_t removed, added;
  };
  /// Returns the distance to the nearest triangle that both lists have.
  std::optional<Ahead> near() const {
    for (size_t sum = 1; sum <= kAhead; ++sum) {
      for (size_t a = 0; a <= sum; ++a) {
        if (same(i_ + a, j_ + (sum - a))) return Ahead{a, sum - a};
      }
    }
    return std::nullopt;
  }
  /// Returns the distance to the next triangle of the old list that the new one has anywhere, or to both ends.
  Ahead far() const {
    const auto key = [](const std::vector<uint32_t>& list, size_t t) {
      return static_cast<uint64_t>(list[3 * t]) << 32U | list[3 * t + 1];  // a directed edge belongs to one triangle
    };
    std::unordered_map<uint64_t, size_t> there;
    for (size_t j = j_; j < count(after_); ++j) there.emplace(key(after_, j), j);
    for (size_t i = i_; i < count(before_); ++i) {
      const auto found = there.find(key(before_, i));
      if (found != there.end() && same(i, found->second)) return {i - i_, found->second - j_};
    }
    return {count(before_) - i_, count(after_) - j_};
  }
  void replace(uint32_t kept) {
    const std::optional<Ahead> nearest = near();
    const auto [removed, added] = nearest ? *nearest : far();
    out_.kept.push_back(kept);
    out_.removed.push_back(static_cast<uint32_t>(removed));
    out_.added.push_back(static_cast<uint32_t>(added));
    const auto first = after_.begin() + static_cast<std::ptrdiff_t>(3 * j_);
    out_.triangles.insert(out_.triangles.end(), first, first + static_cast<std::ptrdiff_t>(3 * added));
    i_ += removed;
    j_ += added;
  }

  const std::vector<uint32_t>&before_, &after_;
  size_t i_ = 0, j_ = 0;
  TriangleEdits out_;
};

}  // namespace

TriangleEdits editsBetween(const std::vector<uint32_t>& before, const std::vector<uint32_t>& after) {
  return Walk(before, after).edits();
}

std::vector<uint32_t> edited(const std::vector<uint32_t>& before, const TriangleEdits& edits) {
  std::vector<uint32_t> out;
  auto at = before.begin(), from = before.begin();
  auto more = edits.triangles.begin();
  for (size_t e = 0; e < edits.kept.size(); ++e) {
    from = at + 3 * static_cast<std::ptrdiff_t>(edits.kept[e]);
    out.insert(out.end(), at, from);
    at = from + 3 * static_cast<std::ptrdiff_t>(edits.removed[e]);
    const auto last = more + 3 * static_cast<std::ptrdiff_t>(edits.added[e]);
    out.insert(out.end(), more, last);
    more = last;
  }
  out.insert(out.end(), at, before.end());
  return out;
}

}  // namespace viscera::nodes
