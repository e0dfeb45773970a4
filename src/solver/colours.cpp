// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/colours.h"

namespace viscera {

Coloured byColour(const std::vector<uint32_t>& active, bool volume) {
  Coloured out;
  for (uint32_t colour = 0; colour < colourCount(volume); ++colour) {
    const uint32_t first = static_cast<uint32_t>(out.slots.size());
    for (uint32_t slot : active) {
      if (colourOf(slot, volume) == colour) out.slots.push_back(slot);
    }
    out.colours.push_back({first, static_cast<uint32_t>(out.slots.size()) - first});
  }
  return out;
}

}  // namespace viscera
