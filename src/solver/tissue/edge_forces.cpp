// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tissue/edge_forces.h"

#include <algorithm>
#include <numeric>

namespace viscera {

namespace {

/// Hands springs over along paths until no node owns more than its share.
class Sharing {
 public:
  Sharing(const std::vector<layout::SpringEnds>& springs, size_t slots)
      : springs_(springs), by_b_(springs.size(), 0), owned_(slots, 0), seen_(slots, 0), through_(slots, 0) {
    listSprings();
    for (uint32_t s = 0; s < springs_.size(); ++s) {
      by_b_[s] = owned_[springs_[s].b] < owned_[springs_[s].a] ? 1 : 0;
      ++owned_[ownerOf(s)];
    }
  }

  std::vector<uint8_t> shared() {
    if (springs_.empty()) return {};
    size_t nodes = 0;
    for (size_t slot = 0; slot + 1 < starts_.size(); ++slot) nodes += starts_[slot] < starts_[slot + 1] ? 1 : 0;
    size_t share = (springs_.size() + nodes - 1) / nodes;
    while (!keepTo(share)) ++share;
    return by_b_;
  }

 private:
  static constexpr uint32_t kNever = 0xffffffffu;

  uint32_t ownerOf(uint32_t s) const { return by_b_[s] ? springs_[s].b : springs_[s].a; }
  uint32_t otherOf(uint32_t s) const { return by_b_[s] ? springs_[s].a : springs_[s].b; }

  void listSprings() {
    starts_.assign(owned_.size() + 1, 0);
    for (const layout::SpringEnds& ends : springs_) {
      ++starts_[ends.a + 1];
      ++starts_[ends.b + 1];
    }
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    around_.resize(2 * springs_.size());
    std::vector<uint32_t> next(starts_.begin(), starts_.end() - 1);
    for (uint32_t s = 0; s < springs_.size(); ++s) {
      around_[next[springs_[s].a]++] = s;
      around_[next[springs_[s].b]++] = s;
    }
  }

  /// @return whether none owns more
  bool keepTo(size_t share) {
    std::fill(seen_.begin(), seen_.end(), 0);
    search_ = 0;
    bool kept = true;
    for (uint32_t node = 0; node < owned_.size(); ++node) {
      while (owned_[node] > share && relieve(node, share)) {
      }
      kept &= owned_[node] <= share;
    }
    return kept;
  }

  /// Looks for the nearest node that owns less than its share, over springs that could be handed on, and hands them on.
  bool relieve(uint32_t from, size_t share) {
    if (seen_[from] == kNever) return false;
    ++search_;
    queue_.assign(1, from);
    seen_[from] = search_;
    for (size_t i = 0; i < queue_.size(); ++i) {
      const uint32_t node = queue_[i];
      for (uint32_t at = starts_[node]; at < starts_[node + 1]; ++at) {
        const uint32_t s = around_[at], next = otherOf(s);
        if (ownerOf(s) != node || seen_[next] >= search_) continue;
        seen_[next] = search_;
        through_[next] = s;
        if (owned_[next] < share) {
          handOver(from, next);
          return true;
        }
        queue_.push_back(next);
      }
    }
    // No way out of these nodes, nor will there be one: later searches spare themselves the way in.
    for (const uint32_t node : queue_) seen_[node] = kNever;
    return false;
  }

  void handOver(uint32_t from, uint32_t to) {
    --owned_[from];
    ++owned_[to];
    for (uint32_t node = to; node != from;) {
      const uint32_t s = through_[node], before = ownerOf(s);
      by_b_[s] ^= 1;
      node = before;
    }
  }

  const std::vector<layout::SpringEnds>& springs_;
  std::vector<uint8_t> by_b_;
  std::vector<size_t> owned_;              ///< [slots] springs
  std::vector<uint32_t> starts_, around_;  ///< [slots + 1], [2 * springs] springs of a node
  std::vector<uint32_t> seen_, through_;   ///< [slots] search that came by, and the spring by which
  std::vector<uint32_t> queue_;
  uint32_t search_ = 0;
};

/// All links of springs that their nodes own, node by node, then all others likewise. @return [slots] EdgeForces::links
std::vector<layout::uvec4> orderLinks(const std::vector<uint8_t>& by_b, JoinedNetwork& network) {
  std::vector<uint8_t> is_own(network.links.size(), 0);
  for (size_t s = 0; s < by_b.size(); ++s) is_own[by_b[s] ? network.springs[s].link_b : network.springs[s].link_a] = 1;
  std::vector<uint32_t> place(network.links.size());
  std::vector<layout::uvec4> out(network.starts.size() - 1);
  uint32_t next_own = 0, next_other = static_cast<uint32_t>(by_b.size());
  for (size_t slot = 0; slot < out.size(); ++slot) {
    out[slot] = {next_own, next_own, next_other, next_other};
    for (uint32_t link = network.starts[slot]; link < network.starts[slot + 1]; ++link) {
      place[link] = is_own[link] ? next_own++ : next_other++;
    }
    out[slot].y = next_own;
    out[slot].w = next_other;
  }
  const std::vector<layout::Link> links = network.links;
  for (size_t link = 0; link < links.size(); ++link) network.links[place[link]] = links[link];
  for (layout::SpringEnds& ends : network.springs) {
    ends.link_a = place[ends.link_a];
    ends.link_b = place[ends.link_b];
  }
  return out;
}

}  // namespace

std::vector<uint8_t> ownedByB(const std::vector<layout::SpringEnds>& springs, size_t slots) {
  return Sharing(springs, slots).shared();
}

EdgeForces orderByOwner(JoinedNetwork& network) {
  EdgeForces out;
  if (network.starts.empty()) return out;
  const auto slots = static_cast<uint32_t>(network.starts.size() - 1);
  out.links = orderLinks(ownedByB(network.springs, slots), network);
  out.starts.push_back(0);
  std::vector<uint32_t> next;  // [slots] place of a force by others
  for (uint32_t slot = 0; slot < slots; ++slot) {
    const layout::uvec4& runs = out.links[slot];
    const uint32_t place = out.starts.back(), sums = runs.x < runs.y ? 1 : 0;  // of its own, if there are any
    if (sums) out.owners.push_back({slot, runs.x, runs.y, place});
    next.push_back(place + sums);
    out.starts.push_back(place + sums + runs.w - runs.z);
  }
  for (size_t link = 0; link < network.springs.size(); ++link) {  // of owners
    layout::Link& its = network.links[link];
    its.lattice_spring |= next[its.far]++ << layout::kForcePlaceShift;
  }
  return out;
}

}  // namespace viscera
