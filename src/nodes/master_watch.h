// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace viscera::nodes {

/// Notices that the ROS master is gone, or was restarted and no longer knows this node. roscpp never registers again,
/// so that a node would go on unseen for ever.
class MasterWatch {
 public:
  /// Asks the master, once a second at most. @return false once it has not known this node for some seconds
  bool check();

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point asked_{}, known_ = Clock::now();
};

}  // namespace viscera::nodes
