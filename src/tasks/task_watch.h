// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tasks/cut_watch.h"
#include "tasks/spared_parts.h"
#include "tasks/task.h"
#include "tasks/task_judge.h"
#include "tasks/tool_log.h"
#include "viscera/session/session_log.h"

namespace viscera {

enum class TaskPhase { kWaiting, kRunning, kPassed, kFailed };

/// State of a task.
struct TaskStatus {
  TaskPhase state = TaskPhase::kWaiting;
  std::string step;     ///< what the trainee has to do now; at the end, why the task was passed or failed
  double time_s = 0;    ///< simulated time since the clock began [s]
  double progress = 0;  ///< 0..1
  double penalties_s = 0;
  double score = 0;      ///< score so far; 0 for a goal that was not reached
  bool reached = false;  ///< whether the goal was reached, at the end
  TaskTally tally;
};
const char* nameOf(TaskPhase state);
/// Returns the present cost of a measure [s].
double costOf(const TaskConfig& task, const TaskTally& tally, const TaskMeasure& measure);

/// Task that has ended.
struct TaskResult {
  TaskConfig task;
  TaskStatus status;
  ToolRows tools;                ///< since the clock began
  std::vector<Vector3d> cuts_m;  ///< in the rest shape
  uint32_t springs_cut = 0;      ///< number since the last reset
};

/// Log that judges the tasks of a session (Session::recordTask()), tick by tick and in order. The same ticks give the
/// same score, however late measurements arrive. After a reset, a task begins again. It shows the marks
/// of its task on the tissue (Session::showMarks()).
class TaskWatch : public SessionLog {
 public:
  /// @param session  must outlive this   @param ended  receives each task that has ended; may be null
  explicit TaskWatch(Session& session, std::function<void(TaskResult&&)> ended = {});
  ~TaskWatch() override;
  TaskWatch(const TaskWatch&) = delete;
  TaskWatch& operator=(const TaskWatch&) = delete;

  const TaskConfig* task() const { return task_ ? &*task_ : nullptr; }  ///< the last task; null: none was begun
  const TaskStatus& status() const { return status_; }
  /// Ends an undecided task as failed. Call it once the last tick was waited for.
  void giveUp(const std::string& why);

  void stepped(Session& session, const StylusSamples& samples) override;
  void measured(const Session& session, uint64_t tick, const layout::TickStats& stats) override;
  void wasReset() override;
  void restored(Session& session) override;
  /// Begins a task. @throws TaskError  the yaml is not a task
  void taskRecorded(Session& session, const std::string& name, const std::string& yaml) override;

 private:
  /// Returns whether cut springs are needed. Then ticks that may have cut are waited for.
  bool needsCuts() const { return judge_->usesCuts() || !spared_->isEmpty(); }
  SparedParts sparedParts(const TaskConfig& task) const;
  bool isOpen() const { return task_ && status_.state <= TaskPhase::kRunning; }
  void begin(std::unique_ptr<TaskJudge> judge);
  void showMarks();
  bool partsFibres(const std::vector<FibreState>& fibres);
  void judgeNoted();
  void judge(const TaskTick& tick);
  void count(const TaskTick& tick);
  std::string exceeded(const TaskRule& rule) const;
  void decide();
  void end(TaskPhase state, const std::string& why);

  Session& session_;
  const std::function<void(TaskResult&&)> ended_;
  std::optional<TaskConfig> task_;
  std::unique_ptr<TaskJudge> judge_;
  std::optional<CutWatch> cut_watch_;
  std::optional<SparedParts> spared_;
  std::vector<MarkState> mark_states_;  ///< of the marks that are shown
  CutState cuts_;
  size_t whole_fibres_ = 0;  ///< number after the last tick
  TaskStatus status_;
  uint64_t base_tick_ = 0;                       ///< measurements up to this tick belong to earlier ticks
  double base_blood_ml_ = 0, base_bile_ml_ = 0;  ///< lost before the task
  std::deque<TaskTick> stepped_;
  std::deque<layout::TickStats> measured_;
  std::optional<ToolRows> tools_;
  std::vector<Vector3d> cuts_m_;
  uint32_t springs_cut_ = 0;
};

}  // namespace viscera
