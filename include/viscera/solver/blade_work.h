// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace viscera {

/// What a stylus's blade did to tissue that resists it (material.cut, docs/cutting.md).
struct BladeWork {
  double area_m2 = 0;    ///< parted since the last reset, at rest
  double work_j = 0;     ///< by the hand since then, what the tissue gave back taken off
  double parting_j = 0;  ///< of that what went into the area: toughness, as far as the lattice carries it, times area
  double limit_n = 0;    ///< force at which the edge goes on, as it lay in the last tick; 0: it lies in no tissue
};

}  // namespace viscera
