// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <memory>
#include <thread>

#include "viscera/math/error.h"

namespace viscera::nodes {

/// An idle connection to the ROS master's port, which detects at once that the master has ended. Without a connection
/// (the master may not be reachable like this) it detects nothing.
class MasterLine {
 public:
  MasterLine() = default;
  ~MasterLine() { close(); }
  MasterLine(const MasterLine&) = delete;
  MasterLine& operator=(const MasterLine&) = delete;

  bool open();  ///< @returns whether the port accepts connections
  /// Waits for at most `limit`. @returns whether the connection was open and the other side has closed it
  bool broken(std::chrono::milliseconds limit);

 private:
  void close();
  int socket_ = -1;
};

/// Error after the ROS master was lost. The loss has been logged, and the end of the process has begun.
struct MasterLost : Error {
  MasterLost();
};

/// Detects that the ROS master is gone, was restarted and does not know this node, or does not answer. roscpp never
/// registers again, so the node would continue without being reachable. A separate thread queries the master once a
/// second, and at once when the connection to it ends, since roscpp waits for an answer without limit. If the node does
/// not check for a loss within 5 s, as while it advertises a topic, that thread begins the end of the process.
class MasterWatch {
 public:
  MasterWatch();
  ~MasterWatch();  ///< does not wait for an answer
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

  /// Checks the master without waiting for an answer.
  /// @return false once the master is gone, or has not known this node or not answered for some seconds
  bool check() const;
  /// Checks the master. @throws MasterLost  check() returns false
  void require() const {
    if (!check()) throw MasterLost();
  }

 private:
  struct Shared;
  static void ask(const std::shared_ptr<Shared>& shared);
  const std::shared_ptr<Shared> shared_;  ///< shared with the thread, which may outlive this object
  std::thread thread_;
};

}  // namespace viscera::nodes
