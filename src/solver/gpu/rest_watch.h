// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "layout/awake_bricks.h"
#include "solver/gpu/buffers/awake_bricks.h"
#include "viscera/model/model.h"

namespace viscera {

/// Detector that determines, from late read-back data, whether all tissue sleeps, so that the host need not send
/// anything to the GPU. Skipped work would change nothing, so no result depends on the delay. Ticks are numbered by the
/// measurements that they return.
class RestWatch {
 public:
  /// @param may_rest  all tissue may sleep, and none falls asleep in the tick that wakes it
  RestWatch(const Model& model, bool may_rest);

  void beginTick();
  bool resting() const { return resting_; }
  /// Records that something may wake tissue anywhere.
  void disturb();
  /// Records that tools act within boxes.
  /// @return whether this may wake anything
  bool disturbNear(const std::vector<ToolBox>& boxes);
  /// Records that the measurements of a tick were requested.
  /// @return its number
  uint64_t send() { return tick_++; }
  /// Records that these measurements have arrived.
  void receive(uint64_t tick, const layout::AwakeList& awake);

 private:
  struct Disturbance {
    uint64_t tick;
    std::vector<ToolBox> boxes;  ///< empty: anywhere
  };
  bool mayWake(const std::vector<ToolBox>& boxes) const;

  std::vector<ToolBox> bricks_;  ///< boxes of the bricks at rest
  ToolBox all_;                  ///< box around them
  bool may_rest_, resting_ = false;
  uint64_t tick_ = 0;                      ///< number of the next measurements
  int asleep_ticks_ = 0;                   ///< ticks in a row, up to the last known one, that ended with nothing awake
  float farthest_m_ = 0;                   ///< largest distance of a sleeping node from its rest position
  std::vector<Disturbance> disturbances_;  ///< since the last known tick
};

}  // namespace viscera
