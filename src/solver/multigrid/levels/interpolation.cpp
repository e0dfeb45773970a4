// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/levels/interpolation.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace viscera::multigrid {

namespace {

/// Along each axis a node takes from one place or, half way between them, from two. Coordinates are never negative.
int lowerPlace(int at) {
  return at / 2;
}
int upperPlace(int at) {
  return (at + 1) / 2;
}

/// Which of a node's places one is: x fastest.
uint32_t indexOf(const Vector3i& at, const Vector3i& place) {
  uint32_t out = 0;
  for (int axis = 2; axis >= 0; --axis)
    out = out * static_cast<uint32_t>(1 + (at[axis] & 1)) + static_cast<uint32_t>(place[axis] - lowerPlace(at[axis]));
  return out;
}

/// Calls visit(place) for what lies in two nodes' places, x fastest.
template <class Visit>
void forCommonPlaces(const Vector3i& a, const Vector3i& b, const Visit& visit) {
  Vector3i low, high, place;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = std::max(lowerPlace(a[axis]), lowerPlace(b[axis]));
    high[axis] = std::min(upperPlace(a[axis]), upperPlace(b[axis]));
  }
  for (place.z() = low.z(); place.z() <= high.z(); ++place.z())
    for (place.y() = low.y(); place.y() <= high.y(); ++place.y())
      for (place.x() = low.x(); place.x() <= high.x(); ++place.x()) visit(place);
}
template <class Visit>
void forPlaces(const Vector3i& at, const Visit& visit) {
  forCommonPlaces(at, at, visit);
}

/// In which faces of the cube of nodes that take from a place one lies: a bit each.
uint8_t rimsOf(const Vector3i& at, const Vector3i& place) {
  unsigned out = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int off = at[axis] - 2 * place[axis];
    if (off == -1) out |= 1u << (2 * axis);
    if (off == 1) out |= 2u << (2 * axis);
  }
  return static_cast<uint8_t>(out);
}

/// The faces opposite to some.
unsigned opposite(unsigned rims) {
  constexpr unsigned kLower = 0b010101;
  return (rims & kLower) << 1 | (rims >> 1 & kLower);
}

}  // namespace

Interpolation::Interpolation(const LevelNodes& nodes, const std::vector<uint8_t>& takes, const std::vector<Link>& links)
    : nodes_(nodes) {
  starts_.push_back(0);
  for (size_t node = 0; node < nodes.at.size(); ++node) {
    if (takes[node])
      forPlaces(nodes.at[node], [&](const Vector3i& place) { within_.push_back(rimsOf(nodes.at[node], place)); });
    starts_.push_back(static_cast<uint32_t>(within_.size()));
  }
  reach_ = within_;
  of_.resize(within_.size());
  std::iota(of_.begin(), of_.end(), 0u);
  for (const Joins joins : {Joins::kInside, Joins::kWithinRims, Joins::kToRims}) {
    for (const Link& link : links) join(link, joins);
  }
  number();
  gatherChildren();
}

uint32_t Interpolation::find(uint32_t entry) {
  while (of_[entry] != entry) entry = of_[entry] = of_[of_[entry]];
  return entry;
}

/// A link inside what takes from a place joins its ends. One along a rim does so where both of what it would join lie
/// in that rim, and then where one of them does not go on to the rim opposite to it.
void Interpolation::join(const Link& link, Joins joins) {
  const auto [a, b] = link;
  if (starts_[a] == starts_[a + 1] || starts_[b] == starts_[b + 1]) return;
  const Vector3i &at_a = nodes_.at[a], &at_b = nodes_.at[b];
  forCommonPlaces(at_a, at_b, [&](const Vector3i& place) {
    const unsigned along = rimsOf(at_a, place) & rimsOf(at_b, place);
    if ((along == 0) != (joins == Joins::kInside)) return;
    const uint32_t i = find(starts_[a] + indexOf(at_a, place)), j = find(starts_[b] + indexOf(at_b, place));
    const unsigned both = within_[i] & within_[j];
    if (i == j || (joins == Joins::kWithinRims && (along & both) == 0)) return;
    if (joins == Joins::kToRims && (opposite(along) & reach_[i] & reach_[j]) != 0) return;
    of_[std::max(i, j)] = std::min(i, j);
    within_[std::min(i, j)] = static_cast<uint8_t>(both);
    reach_[std::min(i, j)] |= reach_[std::max(i, j)];
  });
}

/// Numbers coarse nodes, and writes who takes from them.
void Interpolation::number() {
  struct First {
    Vector3i place;
    uint32_t body, entry;
  };
  std::vector<First> firsts;  // entries that stand for a coarse node
  for (uint32_t node = 0; node + 1 < starts_.size(); ++node) {
    if (starts_[node] == starts_[node + 1]) continue;
    uint32_t entry = starts_[node];
    forPlaces(nodes_.at[node], [&](const Vector3i& place) {
      if (find(entry) == entry) firsts.push_back({place, nodes_.body[node], entry});
      ++entry;
    });
  }
  const auto key = [](const First& of) {
    return std::make_tuple(of.body, of.place.z(), of.place.y(), of.place.x(), of.entry);
  };
  std::sort(firsts.begin(), firsts.end(), [&](const First& a, const First& b) { return key(a) < key(b); });
  std::vector<uint32_t> number(of_.size());
  for (uint32_t i = 0; i < firsts.size(); ++i) {
    number[firsts[i].entry] = i;
    coarse.at.push_back(firsts[i].place);
    coarse.body.push_back(firsts[i].body);
  }
  transfer.starts = starts_;
  for (uint32_t node = 0; node + 1 < starts_.size(); ++node) {
    for (uint32_t entry = starts_[node]; entry < starts_[node + 1]; ++entry) {
      transfer.parents.push_back(number[find(entry)]);
      transfer.weights.push_back(1.0f / static_cast<float>(starts_[node + 1] - starts_[node]));
    }
  }
}

void Interpolation::gatherChildren() {
  Transfer& t = transfer;
  t.coarse_starts.assign(coarse.at.size() + 1, 0);
  for (const uint32_t parent : t.parents) ++t.coarse_starts[parent + 1];
  std::partial_sum(t.coarse_starts.begin(), t.coarse_starts.end(), t.coarse_starts.begin());
  std::vector<uint32_t> next(t.coarse_starts.begin(), t.coarse_starts.end() - 1);
  t.children.resize(t.parents.size());
  t.coarse_weights.resize(t.parents.size());
  for (uint32_t node = 0; node + 1 < t.starts.size(); ++node) {
    for (uint32_t i = t.starts[node]; i < t.starts[node + 1]; ++i) {
      const uint32_t to = next[t.parents[i]]++;
      t.children[to] = node;
      t.coarse_weights[to] = t.weights[i];
    }
  }
}

}  // namespace viscera::multigrid
