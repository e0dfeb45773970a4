// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/neighbors.h"

namespace viscera {

int springIndex(const Vector3i& offset) {
  for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
    const auto& o = kNeighborOffsets[s];
    if (offset == Vector3i(o[0], o[1], o[2])) return static_cast<int>(s);
  }
  return -1;
}

void setSpringCount(layout::NodeBits& bits, uint32_t spring, uint32_t count) {
  if (isAxial(spring)) {
    const uint32_t shift = 3u * spring;
    bits.lo = (bits.lo & ~(7u << shift)) | (count << shift);
  } else {
    const uint32_t shift = 2u * (spring - layout::kAxialSprings);
    bits.hi = (bits.hi & ~(3u << shift)) | (count << shift);
  }
}

}  // namespace viscera
