// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "viscera/api.h"
#include "viscera/math/types.h"
#include "viscera/tools/force_limiter.h"

namespace VISCERA_PUBLIC viscera {

/// Contact of one stylus in a tick: the path of its tip and the reaction of the tissue.
struct TickContact {
  enum class Kind {
    kFree,     ///< no contact
    kPushes,   ///< a probe in tissue: the force has one sign only
    kHolds,    ///< a grip: the force has either sign
    kPierces,  ///< a needle in tissue: a force of either sign across it, and a limited one along it
    kPulls     ///< a held suture: a force towards its next point, or none
  };
  Kind kind = Kind::kFree;
  /// Force at which a blade in tissue that resists it, or a needle along its path, advances; the force does not grow
  /// beyond it [N].
  double limit_n = std::numeric_limits<double>::infinity();
  /// @name Of needles
  /// @{
  Vector3d along = Vector3d::Zero();  ///< direction in which it points, unit vector
  double back_n = 0;                  ///< force along it at which it comes back [N]; may be below 0
  double stiffness_n_per_m = 0;       ///< stiffness of the tissue around it, across [N/m]
  /// @}
  bool anew = false;  ///< results of earlier ticks are invalid: a reset, a recovery, another stylus or another mode
  Vector3d from_m = Vector3d::Zero(), to_m = Vector3d::Zero();  ///< path of the tip in the tick, tissue frame [m]
  Reaction reaction;                                            ///< mean over the tick
};

}  // namespace viscera
