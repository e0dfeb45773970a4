// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "layout/awake_bricks.h"
#include "solver/gpu/buffers/awake_bricks.h"
#include "viscera/model/model.h"

namespace viscera {

/// Whether the host knows that all tissue sleeps, from what comes back late: then it need not tell the GPU anything.
/// What is left out would change nothing, so that no result depends on how late that is. Ticks are numbered by the
/// measurements that they send back.
class RestWatch {
 public:
  /// @param may_rest  all tissue may sleep, and none falls asleep in the tick in which it is woken
  RestWatch(const Model& model, bool may_rest);

  void beginTick();
  bool resting() const { return resting_; }
  /// Something is done now that may wake tissue anywhere.
  void disturb();
  /// Tools do something within boxes. @return whether that may wake anything
  bool disturbNear(const std::vector<ToolBox>& boxes);
  /// The measurements of a tick are on their way. @return its number
  uint64_t send() { return tick_++; }
  /// They have come.
  void receive(uint64_t tick, const layout::AwakeList& awake);

 private:
  struct Disturbance {
    uint64_t tick;
    std::vector<ToolBox> boxes;  ///< empty: anywhere
  };
  bool mayWake(const std::vector<ToolBox>& boxes) const;

  std::vector<ToolBox> bricks_;  ///< at rest
  ToolBox all_;                  ///< around them
  bool may_rest_, resting_ = false;
  uint64_t tick_ = 0;     ///< of the measurements that come next
  int asleep_ticks_ = 0;  ///< at the ends of so many ticks, the last of which is known, nothing was awake
  float farthest_m_ = 0;  ///< from its place at rest is a node asleep
  std::vector<Disturbance> disturbances_;  ///< since the last tick that is known
};

}  // namespace viscera
