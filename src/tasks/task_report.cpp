// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/task_report.h"

#include <filesystem>

#include "math/number_text.h"
#include "math/out_file.h"
#include "tasks/report_page.h"
#include "tasks/task_kinds.h"

namespace viscera {

namespace {

/// Returns one row per number: owner, name, value.
std::string reportCsv(const nlohmann::ordered_json& report) {
  TextOut out;
  out << "of,measure,value\n";
  for (const char* key : {"state", "score", "time_s", "progress", "penalties_s"})
    out << "task," << key << ',' << (report[key].is_string() ? report[key].get<std::string>() : report[key].dump())
        << '\n';
  for (const auto& [name, measure] : report["measures"].items())
    out << "task," << name << ',' << measure["value"].dump() << '\n';
  for (const auto& hand : report["tools"])
    for (const auto& [name, value] : hand.items())
      if (value.is_number()) out << hand["stylus"].get<std::string>() << ',' << name << ',' << value.dump() << '\n';
  return out.str();
}

}  // namespace

nlohmann::ordered_json toJson(const TaskResult& result) {
  nlohmann::ordered_json out;
  out["task"] = result.task.name;
  out["title"] = result.task.title;
  out["kind"] = kindOf(result.task.kind).name;
  out["state"] = nameOf(result.status.state);
  out["why"] = result.status.step;
  out["score"] = result.status.score;
  out["pass_score"] = result.task.pass_score;
  out["time_s"] = result.status.time_s;
  out["time_limit_s"] = result.task.time_limit_s;
  out["proficiency_s"] = result.task.proficiency_s;
  out["progress"] = result.status.progress;
  out["penalties_s"] = result.status.penalties_s;
  for (const TaskMeasure& measure : kTaskMeasures)
    out["measures"][measure.name] = {{"value", result.status.tally.*measure.value},
                                     {"cost_s", costOf(result.task, result.status.tally, measure)}};
  out["tools"] = result.hands.metrics();
  return out;
}

void writeReport(const std::string& folder, const TaskResult& result, const std::vector<ReportPicture>& pictures) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(folder + ": cannot create this folder for a report: " + error.message());
  const nlohmann::ordered_json report = toJson(result);
  writeFile(folder + "/report.json", FileKind::kJson,
            report.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  writeFile(folder + "/report.csv", FileKind::kText, reportCsv(report));
  result.hands.write(folder + "/tools.csv");
  result.hands.writeJigsaws(folder + "/kinematics.txt");
  writeFile(folder + "/report.html", FileKind::kHtml, reportPage(result, pictures));
}

}  // namespace viscera
