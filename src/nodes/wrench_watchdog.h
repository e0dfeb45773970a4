// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <chrono>
#include <mutex>

#include "nodes/end_watch.h"
#include "nodes/parameters.h"

namespace viscera::nodes {

struct WatchdogOptions {
  double timeout_s = 0.1;
};
/// @throws ParameterError
WatchdogOptions watchdogOptions(Parameters& parameters);

/// Stands between a simulator and a driver that keeps the last wrench it was told: passes wrenches on, `wrench_in` to
/// `wrench_out`, and sends zeros when they stop, for whatever reason, and when it ends itself.
class WrenchWatchdog {
 public:
  /// @param end  must outlive this
  WrenchWatchdog(const WatchdogOptions& options, EndWatch& end);
  ~WrenchWatchdog();

  /// Until the end begins. @throws Error  the master is lost
  void run();

 private:
  using Clock = std::chrono::steady_clock;
  void onWrench(const geometry_msgs::WrenchStamped& message);
  void sendZero();
  void zeroIfSilent();
  void stop();

  const std::chrono::duration<double> timeout_;
  EndWatch& end_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Publisher out_;
  std::mutex mutex_;
  geometry_msgs::WrenchStamped last_;
  Clock::time_point heard_{}, sent_{};
  bool silent_ = true, stopped_ = false;
  EndWatch::Act act_;
  ros::Subscriber in_;
  ros::AsyncSpinner spinner_;
};

}  // namespace viscera::nodes
