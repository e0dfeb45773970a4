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
  ForcePort port;                    ///< message type and count of the driver; type none: it takes no forces
  std::string topic = "wrench_out";  ///< topic of the driver
};
/// Reads the options.
/// @param package_folder  folder with config/devices/<profile>.yaml   @throws ParameterError, DeviceError
WatchdogOptions watchdogOptions(Parameters& parameters, const std::string& package_folder);

/// Relays forces from a simulator to a driver that keeps applying the last force it received. Passes messages from
/// `wrench_in` to `wrench_out`, and sends zeros when they stop for any reason and when the watchdog itself ends. A
/// thread that waits neither for the master nor for the log sends the zeros.
class WrenchWatchdog {
 public:
  /// @param end  must outlive this object
  WrenchWatchdog(const WatchdogOptions& options, EndWatch& end);
  ~WrenchWatchdog();
  WrenchWatchdog(const WrenchWatchdog&) = delete;
  WrenchWatchdog& operator=(const WrenchWatchdog&) = delete;

  /// Runs until the end begins. Sends nothing to a driver that takes no forces. @throws MasterLost
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
  std::unique_ptr<Line> line_;  ///< relay of messages; null: the driver takes no forces
  Clock::time_point heard_{}, sent_{};
  bool silent_ = true, stopped_ = false;
  bool suspended_ = false;             ///< whether the process is about to be stopped: no messages are relayed
  std::atomic<uint64_t> silences_{0};  ///< number of times that messages stopped
  EndWatch::Act act_;
  std::thread watch_;
  ros::AsyncSpinner spinner_;
};

}  // namespace viscera::nodes
