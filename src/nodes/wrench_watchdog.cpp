// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/wrench_watchdog.h"

#include <ros/console.h>

#include <thread>

#include "nodes/master_watch.h"

namespace viscera::nodes {
namespace {

constexpr std::chrono::milliseconds kPeriod{2};   ///< how late the end of a time-out may be seen
constexpr std::chrono::milliseconds kRepeat{20};  ///< zeros are sent again, for a driver that comes late
/// roscpp writes to sockets on a thread of its own and tells nobody when it has: it has by then.
constexpr std::chrono::milliseconds kFlush{10};
constexpr double kMinTimeout_s = 0.005, kMaxTimeout_s = 10;

}  // namespace

WatchdogOptions watchdogOptions(Parameters& parameters) {
  WatchdogOptions options;
  options.timeout_s = parameters.number("timeout_s", options.timeout_s, kMinTimeout_s, kMaxTimeout_s);
  parameters.refuseOthers();
  return options;
}

WrenchWatchdog::WrenchWatchdog(const WatchdogOptions& options, EndWatch& end)
    : timeout_(options.timeout_s),
      end_(end),
      out_(node_.advertise<geometry_msgs::WrenchStamped>("wrench_out", 1)),
      act_(end, [this] { stop(); }),
      spinner_(1, &queue_) {
  ros::NodeHandle input(node_);
  input.setCallbackQueue(&queue_);
  in_ = input.subscribe("wrench_in", 1, &WrenchWatchdog::onWrench, this, ros::TransportHints().tcpNoDelay());
  spinner_.start();
}

WrenchWatchdog::~WrenchWatchdog() {
  stop();
}

void WrenchWatchdog::run() {
  MasterWatch master;
  while (!end_.waitFor(kPeriod)) {
    zeroIfSilent();
    if (master.check()) continue;
    stop();
    throw Error("the ROS master is lost: start the node again");
  }
}

void WrenchWatchdog::onWrench(const geometry_msgs::WrenchStamped& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (stopped_) return;
  last_ = message;
  heard_ = Clock::now();
  silent_ = false;
  out_.publish(message);
}

void WrenchWatchdog::sendZero() {
  last_.wrench = geometry_msgs::Wrench();
  last_.header.stamp = ros::Time::now();
  out_.publish(last_);
  sent_ = Clock::now();
}

void WrenchWatchdog::zeroIfSilent() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (now - heard_ < timeout_ || (silent_ && now - sent_ < kRepeat)) return;
  if (!silent_) ROS_WARN("no wrench for %.3f s: zeros go out until they come again", timeout_.count());
  silent_ = true;
  sendZero();
}

void WrenchWatchdog::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stopped_) return;
    stopped_ = true;
    sendZero();
  }
  std::this_thread::sleep_for(kFlush);
}

}  // namespace viscera::nodes
