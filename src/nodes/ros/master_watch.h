// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <memory>
#include <thread>

#include "viscera/math/error.h"

namespace viscera::nodes {

/// A connection to the ROS master's port that says nothing: its end is the master's, and is seen at once. Without one
/// (the master cannot be reached in this way) there is nothing to see.
class MasterLine {
 public:
  MasterLine() = default;
  ~MasterLine() { close(); }
  MasterLine(const MasterLine&) = delete;
  MasterLine& operator=(const MasterLine&) = delete;

  bool open();  ///< @returns false: no listener there
  /// Waits so long at most. @returns whether it was open, and the other side has closed it
  bool broken(std::chrono::milliseconds limit);

 private:
  void close();
  int socket_ = -1;
};

/// The ROS master is gone. The log has said so, and the end of the process has begun.
struct MasterLost : Error {
  MasterLost();
};

/// Notices that the ROS master is gone, was restarted and no longer knows this node, or does not answer. roscpp never
/// registers again, so that a node would go on unseen for ever. The master is asked once a second, and at once when the
/// connection to it ends, by a thread of its own: roscpp waits for an answer without limit. Where a loss is not looked
/// at for 5 s, as by a node that advertises a topic just then, that thread begins the end of the process.
class MasterWatch {
 public:
  MasterWatch();
  ~MasterWatch();  ///< does not wait for an answer
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

  /// Does not wait for an answer either.
  /// @return false once it is gone, or has not known this node or not answered for some seconds
  bool check() const;
  /// @throws MasterLost  where check() says false
  void require() const {
    if (!check()) throw MasterLost();
  }

 private:
  struct Shared;
  static void ask(const std::shared_ptr<Shared>& shared);
  const std::shared_ptr<Shared> shared_;  ///< with a thread whose question may outlive this
  std::thread thread_;
};

}  // namespace viscera::nodes
