// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tasks/task_report.h"
#include "tasks/task_watch.h"

namespace viscera::cli {

/// Checks the option --name. @throws Error  it cannot be a trainee's name
void requireTrainee(const std::optional<std::string>& name);

/// Judges the tasks of a session and writes their reports.
class TaskRun {
 public:
  /// @param session  must outlive this object   @param folder  folder of reports; empty: none
  /// @param pictures  whether reports have images, of the first camera   @param trainee  name in the reports; empty:
  /// none   @param page  file of the page of the session, to link; empty: none
  TaskRun(Session& session, std::string folder, bool pictures, std::string trainee, std::string page);
  /// Starts a task with the next step. @throws TaskError
  void begin(const TaskConfig& task);
  /// Ends the tasks after the session's last tick; undecided ones have failed. @returns a map of each task that ended
  /// @throws Error  a report cannot be written
  nlohmann::ordered_json finish();
  const TaskWatch& watch() const { return watch_; }
  /// Prints what finish() found, in a few lines for a person: verdict, costliest mistakes, path of the report.
  void printVerdicts() const;

 private:
  void takePicture(const std::string& caption, const std::string& name);

  Session& session_;
  const std::string folder_;
  const bool pictures_;
  const std::string trainee_, page_;
  std::vector<std::string> lines_;  ///< for printVerdicts()
  std::vector<TaskResult> ended_;
  std::vector<ReportPicture> taken_;
  TaskWatch watch_;
};

}  // namespace viscera::cli
