// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tasks/attempt.h"
#include "tasks/task_watch.h"

namespace viscera {

/// Image of a report, as an existing PNG file.
struct ReportPicture {
  std::string caption, file;
};

/// Returns verdict, score, the measures of the task's kind, and tools of a finished task.
nlohmann::ordered_json toJson(const TaskResult& result, const Attempt& attempt);

/// Writes report.json, report.csv, tools.csv, kinematics.txt (ToolRows::writeJigsaws()) and report.html, a page that
/// needs no network. @param folder  is created if missing   @throws Error  a file cannot be written
void writeReport(const std::string& folder, const TaskResult& result, const Attempt& attempt,
                 const std::vector<ReportPicture>& pictures = {});

}  // namespace viscera
