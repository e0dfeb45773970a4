// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/node_handle.h>

#include <chrono>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "viscera/math/error.h"

namespace viscera::nodes {

/// A stylus that no scene has.
struct StylusUnknown : Error {
  using Error::Error;
};

/// The stylus that a simulator in this node's namespace tells of; empty: it is told of something else.
std::string stylusTold(const diagnostic_msgs::DiagnosticStatus& status);

/// Whether simulators have the stylus that a node stands for, as the diagnostics of those in its namespace tell. Where
/// there are none, or the stylus's topic is remapped, it cannot be said.
class StylusCheck {
 public:
  StylusCheck(ros::NodeHandle& node, const std::string& stylus);
  /// Asked again and again until it is known.
  /// @throws StylusUnknown  all simulators that were heard within kPatience of the first have others; names those
  void require();

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kPatience{2};  ///< simulators tell once a second

  void onDiagnostics(const diagnostic_msgs::DiagnosticArray& message);

  const std::string stylus_;
  std::mutex mutex_;
  std::set<std::string> known_;
  std::optional<Clock::time_point> heard_;  ///< the first simulator
  bool done_ = false;
  ros::Subscriber diagnostics_;
};

}  // namespace viscera::nodes
