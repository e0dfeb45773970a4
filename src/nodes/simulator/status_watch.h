// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/node_handle.h>

#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "nodes/ros/end_watch.h"
#include "nodes/ros/parameters.h"
#include "nodes/simulator/status_screen.h"

namespace viscera::nodes {

struct StatusOptions {
  bool once = false;      ///< whether to end after one screen, as soon as a simulator has reported
  std::string simulator;  ///< name of a node; empty: all
};

/// Reads the private parameters. @throws ParameterError
StatusOptions statusOptions(Parameters& parameters);

/// Prints the /diagnostics of simulators as a screen of text, once a second.
class StatusWatch {
 public:
  explicit StatusWatch(const StatusOptions& options);
  /// Runs until the end begins; with `once`, until a simulator was shown or none reported for kSilent_s.
  /// @returns whether the last screen showed a simulator that reports   @throws MasterLost
  bool run(EndWatch& end);

 private:
  void onDiagnostics(const diagnostic_msgs::DiagnosticArray& message);
  std::vector<ReceivedStatus> statuses() const;
  StatusView view() const;

  using Clock = std::chrono::steady_clock;
  struct Heard {
    ReceivedStatus status;
    Clock::time_point at;
  };
  const StatusOptions options_;
  const Clock::time_point begun_ = Clock::now();
  mutable std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, Heard> heard_;  ///< status by node and part
  ros::NodeHandle node_;
  ros::Subscriber diagnostics_;
};

}  // namespace viscera::nodes
