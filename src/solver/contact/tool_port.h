// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "viscera/math/types.h"

namespace viscera {

/// How nodes are released.
struct Release {
  double speed_m_per_s;   ///< faster nodes are slowed to this speed
  double above_n_s = -1;  ///< least momentum given in the tick for a release [N s]; below 0: always
};

/// Interface of tools to the holder of the tissue: a backend, or the reference. Calls come in the order of a tick. They
/// may be executed later, as long as that order is kept.
class ToolPort {
 public:
  virtual ~ToolPort() = default;
  /// Takes the nodes around the stylus into its grip.
  /// @param stylus  index, < kMaxStyluses   @param pose  of the stylus, tissue frame   @param radius_m  of the grip
  virtual void takeHold(uint32_t stylus, const Pose& pose, double radius_m) = 0;
  virtual void letGo(uint32_t stylus, const Release& release) = 0;
  /// Cuts with the blade's motion in the next substep. @param particles  erase nodes instead of single springs
  virtual void cut(uint32_t stylus, bool particles) = 0;
};

}  // namespace viscera
