// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "viscera/layout/tick_stats.h"
#include "viscera/math/types.h"

namespace viscera {

/// What the tissue around a needle can exert on it: any force across it, along it only forces within limits.
struct NeedleHold {
  Vector3d along = Vector3d::Zero();  ///< mean direction of motion of the part in tissue; 0: no part is in tissue
  double ahead_n = 0;            ///< additional force along at which it advances: puncture or cutting, and friction
  double back_n = 0;             ///< reduction of force at which it retreats: friction
  double stiffness_n_per_m = 0;  ///< stiffness of the tissue across
};

/// Impulses that a stylus gave sutures and needles in a tick.
struct StylusPull {
  Vector3d impulse_ns = Vector3d::Zero();
  Vector3d moment_nms = Vector3d::Zero();  ///< about its tip at the end of the tick
  uint32_t nodes = 0;                      ///< number of nodes that it holds
  NeedleHold needle;                       ///< state at its end; forces are means over the tick
};
using StylusPulls = std::array<StylusPull, layout::kMaxStyluses>;
/// Adds the pulls as if these nodes were nodes of the tissue.
void addTo(layout::TickStats& stats, const StylusPulls& pulls);

}  // namespace viscera
