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

/// Error for a stylus that no scene has.
struct StylusUnknown : Error {
  using Error::Error;
};

/// Returns the stylus that a diagnostic status of a simulator in this node's namespace names; empty if it names none.
std::string stylusReport(const diagnostic_msgs::DiagnosticStatus& status);

/// Checks that simulators have the stylus that a node stands for, by the diagnostics of the simulators in its
/// namespace. The check has no result if there are none or the stylus's topic is remapped.
class StylusCheck {
 public:
  StylusCheck(ros::NodeHandle& node, const std::string& stylus);
  /// Checks the stylus. Call it repeatedly until the result is known.
  /// @throws StylusUnknown  all simulators that reported within kPatience of the first have other styluses; lists them
  void require();

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kPatience{2};  ///< after the first report; simulators report once a second

  void onDiagnostics(const diagnostic_msgs::DiagnosticArray& message);

  const std::string stylus_;
  std::mutex mutex_;
  std::set<std::string> known_;
  std::optional<Clock::time_point> heard_;  ///< time of the first simulator's report
  bool done_ = false;
  ros::Subscriber diagnostics_;
};

}  // namespace viscera::nodes
