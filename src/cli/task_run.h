// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tasks/task_report.h"
#include "tasks/task_watch.h"

namespace viscera::cli {

/// Judges the tasks of a session and writes their reports.
class TaskRun {
 public:
  /// @param session  must outlive this   @param folder  of reports; empty: none   @param pictures  they have some, of
  /// the first camera
  TaskRun(Session& session, std::string folder, bool pictures);
  /// A task begins with the coming step. @throws TaskError
  void begin(const TaskConfig& task);
  /// Of a session whose last tick was waited for: what is not decided has failed. @returns a map of each task that
  /// ended
  /// @throws Error  a report cannot be written
  nlohmann::ordered_json finish();

 private:
  void takePicture(const std::string& caption, const std::string& name);

  Session& session_;
  const std::string folder_;
  const bool pictures_;
  std::vector<TaskResult> ended_;
  std::vector<ReportPicture> taken_;
  TaskWatch watch_;
};

}  // namespace viscera::cli
