// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/skin_ties.h"

#include <algorithm>

namespace viscera {

namespace {

bool contains(const std::array<uint32_t, 3>& triangle, uint32_t slot) {
  return std::find(triangle.begin(), triangle.end(), slot) != triangle.end();
}

}  // namespace

TieFinder::Triangle TieFinder::slotsOf(uint32_t vertex) const {
  return {bindings_[vertex].slot0, bindings_[vertex].slot1, bindings_[vertex].slot2};
}

bool TieFinder::tie(uint32_t a, uint32_t b, std::vector<layout::Tie>& ties) {
  const Triangle from = slotsOf(std::min(a, b)), to = slotsOf(std::max(a, b));
  for (uint32_t slot : from) {
    if (contains(to, slot)) return true;
  }
  const size_t before = ties.size();
  tieDirectly(from, to, ties);
  if (ties.size() > before) return true;
  const uint64_t edge = static_cast<uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
  const auto [entry, is_new] = paths_.try_emplace(edge);
  if (is_new) entry->second = shortestPath(from, to);
  ties.insert(ties.end(), entry->second.ties.begin(), entry->second.ties.end());
  return entry->second.found;
}

void TieFinder::tieDirectly(const Triangle& from, const Triangle& to, std::vector<layout::Tie>& ties) const {
  const size_t before = ties.size();
  for (uint32_t start : from) {
    const Vector3i node = lattice_.nodeAt(start);
    for (uint32_t end : to) {
      const int spring = springIndex(lattice_.nodeAt(end) - node);
      if (spring < 0 || !springCount(lattice_.nodes[start], static_cast<uint32_t>(spring))) continue;
      ties.push_back({start, static_cast<uint32_t>(spring)});
    }
  }
  if (ties.size() > before) ties.back().spring |= layout::kTieEndBit;
}

TieFinder::Path TieFinder::shortestPath(const Triangle& from, const Triangle& to) const {
  struct Step {
    uint32_t slot, previous, spring;
    int length;
  };
  std::unordered_map<uint32_t, Step> reached;
  std::vector<uint32_t> queue(from.begin(), from.end());
  for (uint32_t slot : from) reached[slot] = {slot, slot, 0, 0};
  for (size_t head = 0; head < queue.size(); ++head) {
    const Step here = reached.at(queue[head]);
    if (here.length == kLongestPath) break;
    for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
      if (!springCount(lattice_.nodes[here.slot], spring)) continue;
      const uint32_t next = static_cast<uint32_t>(lattice_.neighborSlot(here.slot, spring));
      if (!reached.try_emplace(next, Step{next, here.slot, spring, here.length + 1}).second) continue;
      if (!contains(to, next)) {
        queue.push_back(next);
        continue;
      }
      Path path{true, {}};
      for (Step s = reached.at(next); s.length > 0; s = reached.at(s.previous)) {
        path.ties.push_back({s.previous, s.spring | layout::kTieEndBit});
      }
      return path;
    }
  }
  return {};
}

}  // namespace viscera
