// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>

namespace viscera::nodes {

/// Detects when several nodes send the same topic: a stylus that two drivers move jumps between them. Thread-safe.
class SenderWatch {
 public:
  using SteadyTime = std::chrono::steady_clock::time_point;

  /// Records a message of a node. @return  true, once: another node sends too
  bool record(const std::string& node, SteadyTime now);
  /// Returns the nodes that sent within the last second, separated by commas; empty if there are fewer than two.
  std::string several(SteadyTime now) const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, SteadyTime> last_;  ///< arrival of the last message of each node
  bool said_ = false;
};

}  // namespace viscera::nodes
