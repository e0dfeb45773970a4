// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>

namespace viscera::nodes {

/// Notices when several nodes send the same: a hand that two drivers move jumps between them. From any thread.
class SenderWatch {
 public:
  using SteadyTime = std::chrono::steady_clock::time_point;

  /// A message of this node has come. @return  true, once: it is not the only one that sends
  bool note(const std::string& node, SteadyTime now);
  /// The nodes that have sent within the last second, with commas between, if there are several; else empty.
  std::string several(SteadyTime now) const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, SteadyTime> last_;  ///< message of each node
  bool said_ = false;
};

}  // namespace viscera::nodes
