// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "viscera/math/types.h"
#include "viscera/tools/force_limiter.h"

namespace viscera {

/// What a tick found out about one stylus: where its tip was led and what the tissue did to it.
struct TickContact {
  enum class Kind {
    kFree,     ///< touches nothing
    kPushes,   ///< a probe in tissue: one direction of force and never the other
    kHolds,    ///< a grip: pushed and pulled
    kPierces,  ///< a needle in tissue: pushed and pulled across, and along it within limits
    kPulls     ///< a thread that is held: towards where it leads to, or not at all
  };
  Kind kind = Kind::kFree;
  /// A blade in tissue that resists it, or a needle along it: where this force is reached it goes on and the force
  /// stays [N].
  double limit_n = std::numeric_limits<double>::infinity();
  /// @name Of needles
  /// @{
  Vector3d along = Vector3d::Zero();  ///< where it heads, unit
  double back_n = 0;                  ///< at this force along, which may be below 0, it comes back
  double stiffness_n_per_m = 0;       ///< of the tissue around it, across
  /// @}
  bool anew = false;  ///< what ticks before it found holds no more: a reset, a recovery, another hand or another mode
  Vector3d from_m = Vector3d::Zero(), to_m = Vector3d::Zero();  ///< the tip's way in the tick, tissue frame
  Reaction reaction;                                            ///< mean over the tick
};

}  // namespace viscera
