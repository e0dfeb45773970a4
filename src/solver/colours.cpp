// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/colours.h"

#include <algorithm>

namespace viscera {

namespace {

/// The least number that no node has that a link joins to this one; those of later slots have none yet.
uint32_t leastFree(const JoinedNetwork& network, uint32_t slot, const std::vector<uint32_t>& given,
                   std::vector<uint8_t>& taken) {
  const uint32_t first = network.starts[slot], last = network.starts[slot + 1];
  taken.assign(last - first + 1, 0);
  for (uint32_t link = first; link < last; ++link) {
    const uint32_t far = network.links[link].far;
    if (far < slot && given[far] < taken.size()) taken[given[far]] = 1;
  }
  return static_cast<uint32_t>(std::find(taken.begin(), taken.end(), 0) - taken.begin());
}

/// [active] colours
std::vector<uint32_t> coloursOf(const std::vector<uint32_t>& active, bool volume, const JoinedNetwork& network) {
  std::vector<uint32_t> out, given(network.rest_m.size());
  std::vector<uint8_t> taken;
  for (const uint32_t slot : active) {
    const bool linked = !network.starts.empty() && network.starts[slot] != network.starts[slot + 1];
    if (!linked) {
      out.push_back(colourOf(slot, volume));
      continue;
    }
    given[slot] = leastFree(network, slot, given, taken);
    out.push_back(volume ? colourCount(true) * given[slot] + colourOf(slot, true) : given[slot]);
  }
  return out;
}

}  // namespace

Coloured byColour(const std::vector<uint32_t>& active, bool volume, const JoinedNetwork& network) {
  const std::vector<uint32_t> colours = coloursOf(active, volume, network);
  const uint32_t count = colours.empty() ? 0 : *std::max_element(colours.begin(), colours.end()) + 1;
  std::vector<std::vector<uint32_t>> slots(count);
  for (size_t i = 0; i < active.size(); ++i) slots[colours[i]].push_back(active[i]);
  Coloured out;
  for (const std::vector<uint32_t>& same : slots) {
    if (same.empty()) continue;
    out.colours.push_back({static_cast<uint32_t>(out.slots.size()), static_cast<uint32_t>(same.size())});
    out.slots.insert(out.slots.end(), same.begin(), same.end());
  }
  return out;
}

}  // namespace viscera
