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
#include "tasks/hand_log.h"
#include "tasks/task.h"
#include "tasks/task_judge.h"
#include "viscera/session/session_log.h"

namespace viscera {

enum class TaskPhase { kWaiting, kRunning, kPassed, kFailed };

/// How far a task is.
struct TaskStatus {
  TaskPhase state = TaskPhase::kWaiting;
  std::string step;     ///< what is to be done now; at the end, why it was passed or failed
  double time_s = 0;    ///< simulated, since the clock began
  double progress = 0;  ///< 0..1
  double penalties_s = 0;
  double score = 0;  ///< so far; of a goal that was not reached 0
  TaskTally tally;
};
const char* nameOf(TaskPhase state);
/// What a measure costs so far [s].
double costOf(const TaskConfig& task, const TaskTally& tally, const TaskMeasure& measure);

/// A task that has ended.
struct TaskResult {
  TaskConfig task;
  TaskStatus status;
  HandRows hands;                ///< from when the clock began
  std::vector<Vector3d> cuts_m;  ///< of the tissue at rest
  uint32_t springs_cut = 0;      ///< since the last reset
};

/// Judges the tasks of a session (Session::noteTask()), tick by tick and in order: the same ticks have the same score,
/// however late measurements come. After a reset, a task begins again.
class TaskWatch : public SessionLog {
 public:
  /// @param session  must outlive this   @param ended  told of each task that has ended; may be null
  explicit TaskWatch(Session& session, std::function<void(TaskResult&&)> ended = {});
  ~TaskWatch() override { session_.removeLog(*this); }
  TaskWatch(const TaskWatch&) = delete;
  TaskWatch& operator=(const TaskWatch&) = delete;

  const TaskConfig* task() const { return task_ ? &*task_ : nullptr; }  ///< the last one; null: none was begun
  const TaskStatus& status() const { return status_; }
  /// One that is not decided has failed. To be called once the last tick was waited for.
  void giveUp(const std::string& why);

  void stepped(Session& session, const StylusSamples& samples) override;
  void measured(const Session& session, uint64_t tick, const layout::TickStats& stats) override;
  void wasReset() override;
  void restored(Session& session) override;
  /// @throws TaskError  the yaml is no task's
  void taskNoted(Session& session, const std::string& name, const std::string& yaml) override;

 private:
  bool isOpen() const { return task_ && status_.state <= TaskPhase::kRunning; }
  void begin(std::unique_ptr<TaskJudge> judge);
  void judgeNoted();
  void judge(const TaskTick& tick);
  void count(const TaskTick& tick);
  void decide();
  void end(TaskPhase state, const std::string& why);

  Session& session_;
  const std::function<void(TaskResult&&)> ended_;
  std::optional<TaskConfig> task_;
  std::unique_ptr<TaskJudge> judge_;
  std::optional<CutWatch> cut_watch_;
  CutState cuts_;
  TaskStatus status_;
  uint64_t base_tick_ = 0;    ///< measurements up to this one are of ticks before
  double base_blood_ml_ = 0;  ///< that had run out before
  std::deque<TaskTick> stepped_;
  std::deque<layout::TickStats> measured_;
  std::optional<HandRows> hands_;
  std::vector<Vector3d> cuts_m_;
  uint32_t springs_cut_ = 0;
};

}  // namespace viscera
