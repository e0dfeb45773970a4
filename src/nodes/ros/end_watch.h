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

/// Handles the end of a process: by SIGINT, SIGTERM or SIGHUP, on request of the ROS master (rosnode kill, a second
/// node of the same name), by its own request, or by a crash. A node that drives a device registers acts that must run
/// before the process ends. They run at once, on a dedicated thread.
/// A node also registers acts that run before a terminal stops the process (SIGTSTP, as by Ctrl-Z, SIGTTIN, SIGTTOU)
/// and after it continues (SIGCONT). There is one EndWatch per process, created before other threads and after
/// ros::init() with NoSigintHandler, since roscpp's own handler would close the topics first. It outlives
/// ros::shutdown(), which may wait for the master without limit.
class EndWatch {
 public:
  /// Act that runs when the end begins or the process is stopped, as long as this object exists.
  class Act {
   public:
    /// @param run      must not throw; in a crash, locks stay in the state that they were in
    /// @param suspend  runs before the process is stopped   @param resume  runs after it continues; neither may throw
    Act(EndWatch& watch, std::function<void()> run, std::function<void()> suspend = {},
        std::function<void()> resume = {});
    ~Act();  ///< waits for a running act
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

  /// Waits until the end has begun and all acts are done. @returns whether they are
  bool waitFor(std::chrono::milliseconds limit);
  /// Begins the end at this process's own request; returns at once. @param status  exit status if the end is forced
  static void begin(int status);
  /// Time that the process has after a signal or request; then it is killed, whatever it does.
  static constexpr std::chrono::milliseconds kLimit{900};
  /// Returns when the process last continued after a terminal or SIGSTOP stopped it; the epoch if it never did.
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
