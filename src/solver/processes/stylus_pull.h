// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "viscera/layout/tick_stats.h"
#include "viscera/math/types.h"

namespace viscera {

/// What the tissue around a needle can do to it: across it all, along it no more than its limits.
struct NeedleHold {
  Vector3d along = Vector3d::Zero();  ///< where the needle heads, mean of what is in tissue; 0: nothing is
  double ahead_n = 0;                 ///< so much more along, and it goes on: puncture or cutting, and friction
  double back_n = 0;                  ///< so much less, and it comes back: friction
  double stiffness_n_per_m = 0;       ///< of the tissue, across
};

/// What a stylus gave threads and needles in a tick.
struct StylusPull {
  Vector3d impulse_ns = Vector3d::Zero();
  Vector3d moment_nms = Vector3d::Zero();  ///< about its tip at the end of the tick
  uint32_t nodes = 0;                      ///< that it holds
  NeedleHold needle;                       ///< at its end; forces are means of the tick
};
using StylusPulls = std::array<StylusPull, layout::kMaxStyluses>;
/// As if these nodes were of the tissue.
void addTo(layout::TickStats& stats, const StylusPulls& pulls);

}  // namespace viscera
