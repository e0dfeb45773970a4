// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace viscera::nodes {

/// A connection to the ROS master's port that says nothing: its end is the master's, and is seen at once. Without one
/// (the master cannot be reached in this way) there is nothing to see.
class MasterLine {
 public:
  MasterLine() = default;
  ~MasterLine() { close(); }
  MasterLine(const MasterLine&) = delete;
  MasterLine& operator=(const MasterLine&) = delete;

  bool open();    ///< @returns false: nobody listens there
  bool broken();  ///< it was open, and the other side has closed it

 private:
  void close();
  int socket_ = -1;
};

/// Notices that the ROS master is gone, or was restarted and no longer knows this node. roscpp never registers again,
/// so that a node would go on unseen for ever.
class MasterWatch {
 public:
  MasterWatch() { line_.open(); }
  /// Asks the master, once a second at most, and at once when the connection to it ends.
  /// @return false once it is gone, or has not known this node for some seconds
  bool check();

 private:
  using Clock = std::chrono::steady_clock;
  MasterLine line_;
  Clock::time_point asked_{}, known_ = Clock::now();
};

}  // namespace viscera::nodes
