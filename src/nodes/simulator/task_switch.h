// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "nodes/ros/saved_folder.h"
#include "nodes/ros/scene_choice.h"
#include "tasks/task_watch.h"
#include "tools/hand_metrics.h"
#include "viscera/Metrics.h"
#include "viscera/TaskState.h"
#include "viscera/session/session_log.h"

namespace viscera::nodes {

/// The task of a simulator: topics `task_state` and `metrics`, the start and the end of a task, its report. What it is
/// told by the session's thread costs a copy of some numbers; all else is done on others.
class TaskSwitch : public SessionLog {
 public:
  /// @param choice  of the scene; its task, if any, waits from the start on   @param saved_folder  of reports
  TaskSwitch(ros::NodeHandle node, const Scene& scene, const SceneChoice& choice, const std::string& package_folder,
             const SavedFolder& saved_folder);
  ~TaskSwitch() override;
  TaskSwitch(const TaskSwitch&) = delete;
  TaskSwitch& operator=(const TaskSwitch&) = delete;

  /// A task that start_task names. @param name  in config/tasks, or path; empty: the last one
  /// @throws Error  there is none, it is wrong, or of another scene
  TaskConfig find(const std::string& name) const;

  // On the session's thread:
  void follow(Session& session);
  void leave();
  /// Everything at rest, and the task begins. @returns its title
  std::string start(Session& session, const TaskConfig& task);
  /// @throws Error  none runs
  std::string end(Session& session);
  /// Between ticks: what it tells is up to date.
  void notice();

  void stepped(Session& session, const StylusSamples& samples) override;
  void measured(const Session& session, uint64_t tick, const layout::TickStats& stats) override;
  void wasReset() override { clear(); }
  void restored(Session&) override { clear(); }
  void taskNoted(Session&, const std::string&, const std::string&) override { clear(); }

 private:
  void clear();
  void report(TaskResult&& result);
  void onTimer();
  Metrics metricsOf(const TaskResult& result) const;

  const SceneChoice choice_;
  const std::string package_folder_;
  const SavedFolder saved_folder_;
  Session* session_ = nullptr;        ///< that is followed
  std::unique_ptr<TaskWatch> watch_;  ///< of the session's thread, as the tallies
  std::vector<HandTally> tallies_;
  std::vector<std::string> styluses_;
  double tick_s_, peak_strain_ = 0;
  uint64_t measured_tick_ = 0;
  uint32_t springs_cut_ = 0;
  mutable std::mutex mutex_;
  std::optional<TaskConfig> last_;  ///< that was chosen
  TaskState state_;                 ///< as it is told next
  Metrics metrics_;
  bool changed_ = true;
  std::future<void> reporting_;
  ros::Publisher state_publisher_, metrics_publisher_;
  std::chrono::steady_clock::time_point noticed_{}, sent_{};
  ros::WallTimer timer_;
};

}  // namespace viscera::nodes
