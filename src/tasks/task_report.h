// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tasks/task_watch.h"

namespace viscera {

/// A picture of a report, as a PNG file that is there.
struct ReportPicture {
  std::string caption, file;
};

/// State, score, measures and hands of a task that has ended.
nlohmann::ordered_json toJson(const TaskResult& result);

/// Writes report.json, report.csv, hands.csv, kinematics.txt (HandRows::writeJigsaws()) and report.html, a page that
/// opens without a network. @param folder  is made if it is not there   @throws Error  one cannot be written
void writeReport(const std::string& folder, const TaskResult& result, const std::vector<ReportPicture>& pictures = {});

}  // namespace viscera
