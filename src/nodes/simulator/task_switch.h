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
#include "nodes/views/task_pictures.h"
#include "tasks/task_watch.h"
#include "tools/tool_metrics.h"
#include "viscera/Metrics.h"
#include "viscera/TaskState.h"
#include "viscera/session/session_log.h"

namespace viscera::nodes {

/// Runs the task of a simulator: topics `task_state` and `metrics`, the start and end of a task, its report. Calls from
/// the session thread copy a few numbers; other threads do the rest.
class TaskSwitch : public SessionLog {
 public:
  /// @param choice  choice of the scene; its task, if any, waits from the start
  /// @param saved_folder  folder of reports
  /// @param trainee  name in the reports until a task is started with another; empty: none
  TaskSwitch(ros::NodeHandle node, const Scene& scene, const SceneChoice& choice, const std::string& package_folder,
             const SavedFolder& saved_folder, const std::string& trainee);
  ~TaskSwitch() override;
  TaskSwitch(const TaskSwitch&) = delete;
  TaskSwitch& operator=(const TaskSwitch&) = delete;

  /// Returns the task for start_task. @param name  name in config/tasks, or path; empty: the last task
  /// @throws Error  there is none, it is invalid, or it belongs to another scene
  TaskConfig find(const std::string& name) const;

  // Called on the session thread:
  /// @param pictures  whether images can be drawn, for reports
  void follow(Session& session, bool pictures);
  void leave();
  /// Resets the session and starts a task. @returns the task's title
  /// @param trainee  name in its report; empty: that of the last start
  std::string start(Session& session, const TaskConfig& task, const std::string& trainee);
  /// Ends the task. @throws Error  no task runs
  std::string end(Session& session);
  /// Adds what reports show to a tick's outputs.
  FrameRequest with(FrameRequest outputs) const;
  /// Updates the published state between ticks. @param frame  of the last tick, for reports
  void notice(const Frame& frame);

  void stepped(Session& session, const StylusSamples& samples) override;
  void measured(const Session& session, uint64_t tick, const layout::TickStats& stats) override;
  void wasReset() override { clear(); }
  void restored(Session&) override { clear(); }
  void taskRecorded(Session&, const std::string&, const std::string&) override { clear(); }

 private:
  void clear();
  struct Ended {
    TaskResult result;
    std::string folder;
    Attempt attempt;
  };
  void report(TaskResult&& result);
  void writeReport();
  void onTimer();
  Metrics metricsOf(const TaskResult& result) const;

  const SceneChoice choice_;
  const std::string package_folder_;
  const SavedFolder saved_folder_;
  Session* session_ = nullptr;        ///< session that is followed
  std::unique_ptr<TaskWatch> watch_;  ///< used on the session thread, like the tallies
  std::vector<ToolTally> tallies_;
  std::vector<std::string> styluses_;
  std::string trainee_;
  TaskPictures pictures_;       ///< of the running task
  std::optional<Ended> ended_;  ///< waits for its last image
  bool has_started_ = false;    ///< a task was started that is not published yet
  double tick_s_, peak_strain_ = 0;
  uint64_t measured_tick_ = 0;
  uint32_t springs_cut_ = 0;
  mutable std::mutex mutex_;
  std::optional<TaskConfig> last_;  ///< task that was chosen last
  TaskState state_;                 ///< state that is published next
  Metrics metrics_;
  bool changed_ = true;
  std::future<void> reporting_;
  ros::Publisher state_publisher_, metrics_publisher_;
  std::chrono::steady_clock::time_point noticed_{}, sent_{};
  ros::WallTimer timer_;
};

}  // namespace viscera::nodes
