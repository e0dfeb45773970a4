// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace viscera::nodes {

/// How a process ends: by SIGINT, SIGTERM or SIGHUP, on the ROS master's demand (rosnode kill, a second node of the
/// same name), by its own request, or by a crash. A node that drives a device names here what must be done before,
/// which happens at once, on a thread that nothing else uses; and what before a terminal stops the process (SIGTSTP,
/// as by Ctrl-Z, SIGTTIN, SIGTTOU), which goes on at SIGCONT. One per process, made before other threads and after
/// ros::init() with NoSigintHandler, as roscpp's own handling would close the topics first. It outlives
/// ros::shutdown(), which waits for the master for ever.
class EndWatch {
 public:
  /// What is done when the end begins, or the process is stopped, for as long as this object lives.
  class Act {
   public:
    /// @param run      must not throw; in a crash, locks are as they were then
    /// @param suspend  before the process is stopped   @param resume  after it went on; none of them may throw
    Act(EndWatch& watch, std::function<void()> run, std::function<void()> suspend = {},
        std::function<void()> resume = {});
    ~Act();  ///< waits for it if it is under way
    Act(const Act&) = delete;
    Act& operator=(const Act&) = delete;

   private:
    friend class EndWatch;
    EndWatch& watch_;
    const std::function<void()> run_, suspend_, resume_;
  };

  EndWatch();
  ~EndWatch();
  EndWatch(const EndWatch&) = delete;
  EndWatch& operator=(const EndWatch&) = delete;

  /// Waits until the end has begun and what is done before is done; @returns whether it has.
  bool waitFor(std::chrono::milliseconds limit);
  /// The end begins, at this process's own request; returns at once. @param status  of a process ended by force
  static void begin(int status);
  /// From a signal, a demand or a request the process has this long; then it is ended, whatever it is doing.
  static constexpr std::chrono::milliseconds kLimit{900};
  /// When the process last went on after it was stopped, by a terminal or by SIGSTOP; the epoch: never.
  static std::chrono::steady_clock::time_point continued();

 private:
  void main();
  void runActs();
  void beStopped();
  [[noreturn]] static void endByForce();

  std::mutex acts_mutex_;
  std::vector<const Act*> acts_;

  std::mutex mutex_;
  std::condition_variable changed_;
  bool begun_ = false, closing_ = false;
  std::thread thread_;
};

}  // namespace viscera::nodes
