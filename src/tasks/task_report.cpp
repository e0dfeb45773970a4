// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/task_report.h"

#include <filesystem>

#include "math/number_text.h"
#include "math/out_file.h"
#include "tasks/report_page.h"
#include "tasks/task_kinds.h"
#include "tasks/task_notes.h"
#include "tasks/verdict.h"

namespace viscera {

namespace {

using ReportJson = nlohmann::ordered_json;

/// Returns a text as a field of a CSV row.
std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

/// Returns one row per number or text: owner, name, value.
std::string reportCsv(const ReportJson& report) {
  TextOut out;
  out << "of,measure,value\n";
  for (const auto& [name, value] : report["attempt"].items())
    out << "attempt," << name << ',' << csvField(value.get<std::string>()) << '\n';
  for (const char* key : {"state", "failed_limit", "score", "time_s", "progress", "penalties_s"})
    out << "task," << key << ',' << (report[key].is_string() ? report[key].get<std::string>() : report[key].dump())
        << '\n';
  for (const auto& [name, measure] : report["measures"].items())
    out << "task," << name << ',' << measure["value"].dump() << '\n';
  for (const auto& tool : report["tools"])
    for (const auto& [name, value] : tool.items())
      if (value.is_number()) out << tool["stylus"].get<std::string>() << ',' << name << ',' << value.dump() << '\n';
  return out.str();
}

}  // namespace

nlohmann::ordered_json toJson(const TaskResult& result, const Attempt& attempt) {
  const TaskConfig& task = result.task;
  const TaskStatus& status = result.status;
  ReportJson out;
  out["task"] = task.name;
  out["title"] = task.title;
  out["kind"] = kindOf(task.kind).name;
  out["attempt"] = {{"name", attempt.trainee},
                    {"date", attempt.date},
                    {"version", attempt.version},
                    {"state_hash", attempt.state_hash}};
  out["state"] = nameOf(status.state);
  out["why"] = status.step;
  out["failed_limit"] = failedLimit(task, status);
  out["verdict"] = verdictText(task, status);
  out["score"] = status.score;
  out["pass_score"] = task.pass_score;
  out["time_s"] = status.time_s;
  out["time_limit_s"] = task.time_limit_s;
  out["proficiency_s"] = task.proficiency_s;
  out["progress"] = status.progress;
  out["penalties_s"] = status.penalties_s;
  for (const TaskMeasure& measure : kTaskMeasures) {
    if (!isCounted(measure.name, task)) continue;
    ReportJson& row = out["measures"][measure.name];
    row = {{"value", status.tally.*measure.value},
           {"unit", measure.unit},
           {"cost_s", costOf(task, status.tally, measure)}};
    const std::optional<double> most = mostOf(task, measure);
    if (!most) continue;
    row["most"] = *most;
    row["failed"] = isExceeded(task, status.tally, measure);
  }
  out["tools"] = result.tools.metrics();
  return out;
}

void writeReport(const std::string& folder, const TaskResult& result, const Attempt& attempt,
                 const std::vector<ReportPicture>& pictures) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(folder + ": cannot create this folder for a report: " + error.message());
  const ReportJson report = toJson(result, attempt);
  writeFile(folder + "/report.json", FileKind::kJson,
            report.dump(2, ' ', false, ReportJson::error_handler_t::replace) + "\n");
  writeFile(folder + "/report.csv", FileKind::kText, reportCsv(report));
  result.tools.write(folder + "/tools.csv");
  result.tools.writeJigsaws(folder + "/kinematics.txt");
  writeFile(folder + "/report.html", FileKind::kHtml, reportPage(result, attempt, pictures));
}

}  // namespace viscera
