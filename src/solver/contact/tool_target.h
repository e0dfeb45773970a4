// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "viscera/math/types.h"

namespace viscera {

/// How nodes are let go.
struct Release {
  double speed_m_per_s;   ///< faster nodes are slowed to this
  double above_n_s = -1;  ///< only if the stylus gave more momentum than this in the tick; below 0: in any case
};

/// What tools ask of what holds the tissue: a backend, or the reference. It is asked in the order of a tick, and may
/// do it later, as long as that order stays.
class ToolTarget {
 public:
  virtual ~ToolTarget() = default;
  /// @param stylus  index, < kMaxStyluses   @param pose  of the stylus, tissue frame   @param radius_m  of the grip
  virtual void takeHold(uint32_t stylus, const Pose& pose, double radius_m) = 0;
  virtual void letGo(uint32_t stylus, const Release& release) = 0;
  /// Cuts with the blade's motion in the substep that comes. @param particles  erase nodes instead of single springs
  virtual void cut(uint32_t stylus, bool particles) = 0;
};

}  // namespace viscera
