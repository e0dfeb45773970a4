// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "devices/device_profile.h"
#include "nodes/ros/end_watch.h"
#include "nodes/ros/parameters.h"

namespace viscera::nodes {

struct WatchdogOptions {
  double timeout_s = 0.1;
  ForcePort port;                    ///< what the driver takes: its type and message count; of type none: nothing
  std::string topic = "wrench_out";  ///< to the driver
};
/// @param package_folder  where config/devices/<profile>.yaml are looked up   @throws ParameterError, DeviceError
WatchdogOptions watchdogOptions(Parameters& parameters, const std::string& package_folder);

/// Stands between a simulator and a driver that keeps the last force it was told: passes messages on, `wrench_in` to
/// `wrench_out`, and sends zeros when they stop, for whatever reason, and when it ends itself. Zeros come from a thread
/// that never waits: neither for the master nor for readers of the log.
class WrenchWatchdog {
 public:
  /// @param end  must outlive this
  WrenchWatchdog(const WatchdogOptions& options, EndWatch& end);
  ~WrenchWatchdog();
  WrenchWatchdog(const WrenchWatchdog&) = delete;
  WrenchWatchdog& operator=(const WrenchWatchdog&) = delete;

  /// Until the end begins. A driver that takes no forces is left alone. @throws MasterLost
  void run();

 private:
  using Clock = std::chrono::steady_clock;
  class Line;
  template <class Message>
  class LineOf;

  void pass(const std::function<void()>& send);
  void sendZero();
  void watch();
  void stop();
  void suspend();
  void resume();

  const Clock::duration timeout_;
  EndWatch& end_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::unique_ptr<Line> line_;  ///< null: the driver takes no forces
  Clock::time_point heard_{}, sent_{};
  bool silent_ = true, stopped_ = false;
  bool suspended_ = false;             ///< the process is about to be stopped: nothing is passed on
  std::atomic<uint64_t> silences_{0};  ///< that have begun
  EndWatch::Act act_;
  std::thread watch_;
  ros::AsyncSpinner spinner_;
};

}  // namespace viscera::nodes
