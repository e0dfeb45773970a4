// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/surface/surface.h"

namespace viscera {

void appendShown(const uint32_t* corners, const uint32_t* splits, uint32_t alive, std::vector<uint32_t>& out) {
  if (alive == layout::kShownWhole) out.insert(out.end(), corners, corners + 3);
  if (alive <= layout::kShownWhole) return;
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t j = (i + 1) % 3, k = (i + 2) % 3;
    const uint32_t behind_j = splits[2 * i + 1], behind_k = splits[2 * k];
    if (alive & (layout::kShownCorner << i)) {
      out.insert(out.end(), {corners[i], splits[2 * i], splits[2 * k + 1]});
    }
    if (alive & (layout::kShownRest << i)) {
      out.insert(out.end(), {behind_j, corners[j], corners[k], behind_j, corners[k], behind_k});
    }
  }
}

}  // namespace viscera
