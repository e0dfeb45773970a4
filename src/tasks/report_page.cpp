// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/report_page.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "math/base64.h"
#include "tasks/plot.h"
#include "tasks/report_plots.h"
#include "tasks/task_kinds.h"
#include "tasks/task_notes.h"
#include "tasks/verdict.h"

namespace viscera {

namespace {

std::string cell(const std::string& text) {
  return "<td>" + text + "</td>";
}

/// Returns a row of the table of measures. @param most, outcome  empty: no limit
std::string measureRow(const std::string& name, const std::string& value, const std::string& unit,
                       const std::string& cost, const std::string& limit, bool failed) {
  const std::string outcome = limit.empty() ? "" : failed ? "failed" : "kept";
  return std::string("<tr") + (failed ? " class='exceeded'" : "") + ">" + cell(name) + cell(value) + cell(unit) +
         cell(cost) + cell(limit) + cell(outcome) + "</tr>\n";
}

/// Returns the limits and measures that the task's kind counts.
std::string measureTable(const TaskResult& result) {
  const TaskConfig& task = result.task;
  const TaskStatus& status = result.status;
  const bool late = failedLimit(task, status) == "time_limit_s";
  std::string out =
      "<table class='measures'><tr><th>measure</th><th>value</th><th>unit</th><th>cost, points</th><th>limit</th>"
      "<th>outcome</th></tr>\n";
  out += measureRow("time", plainNumber(status.time_s), "s", plainNumber(status.time_s),
                    "at most " + plainNumber(task.time_limit_s), late);
  for (const TaskMeasure& measure : kTaskMeasures) {
    if (!isCounted(measure.name, task)) continue;
    const double value = status.tally.*measure.value, cost = costOf(task, status.tally, measure);
    const std::optional<double> most = mostOf(task, measure);
    out += measureRow("<span title='" + htmlText(measure.meaning) + "'>" + htmlText(phraseOf(task, measure)) +
                          "</span> <code>" + measure.name + "</code>",
                      plainNumber(value), measure.unit, plainNumber(cost), most ? "at most " + plainNumber(*most) : "",
                      isExceeded(task, status.tally, measure));
  }
  out += measureRow("score", plainNumber(status.score), "points", "", "at least " + plainNumber(task.pass_score),
                    !status.reached || status.score < task.pass_score);
  return out + "</table>\n";
}

/// Returns the unit that the end of a metric's name states.
std::string unitOf(const std::string& name) {
  constexpr std::pair<const char*, const char*> kUnits[] = {
      {"_ns", "N s"}, {"_n3", "N&#179;"}, {"_s", "s"}, {"_m", "m"}, {"_n", "N"}};
  for (const auto& [end, unit] : kUnits) {
    const std::string ending = end;
    if (name.size() > ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0)
      return unit;
  }
  return "";
}

std::string toolTable(const TaskResult& result) {
  const nlohmann::ordered_json tools = result.tools.metrics();
  std::string out = "<table><tr><th>tool</th>";
  for (const auto& tool : tools) out += "<th>" + htmlText(tool["stylus"].get<std::string>()) + "</th>";
  out += "<th>unit</th></tr>\n";
  const nlohmann::ordered_json first = tools.empty() ? nlohmann::ordered_json::object() : tools[0];
  for (const auto& [name, unused] : first.items()) {
    if (!unused.is_number()) continue;
    out += "<tr>" + cell(name);
    for (const auto& tool : tools) out += cell(plainNumber(tool[name].get<double>()));
    out += cell(unitOf(name)) + "</tr>\n";
  }
  return out + "</table>\n";
}

std::string pictureHtml(const ReportPicture& picture) {
  std::ifstream file(picture.file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file || bytes.empty()) throw Error(picture.file + ": cannot be read for the report");
  return "<figure><img alt='" + htmlText(picture.caption) + "' src='data:image/png;base64," + base64(bytes) +
         "'><figcaption>" + htmlText(picture.caption) + "</figcaption></figure>\n";
}

/// Returns a plot with its title and the colors of the tools.
std::string figure(const TaskResult& result, const std::string& title, const std::string& svg) {
  std::string names;
  for (size_t s = 0; s < result.tools.styluses.size(); ++s)
    names += " <span style='color:" + std::string(plotColor(s)) + "'>&#9632; " + htmlText(result.tools.styluses[s]) +
             "</span>";
  return "<figure><figcaption>" + title + names + "</figcaption>" + svg + "</figure>\n";
}

std::string attemptTable(const TaskResult& result, const Attempt& attempt) {
  std::string out = "<table class='attempt'>";
  const auto row = [&](const char* name, const std::string& value) {
    if (!value.empty()) out += std::string("<tr><td>") + name + "</td><td>" + htmlText(value) + "</td></tr>\n";
  };
  row("trainee", attempt.trainee);
  row("date (UTC)", attempt.date);
  row("task", result.task.name + " (" + kindOf(result.task.kind).name + ")");
  row("viscera", attempt.version);
  row("state hash", attempt.state_hash);
  return out + "</table>\n";
}

std::string plainBlock(const std::string& text) {
  std::string out = "<pre>";
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.size(), text.find('\n', at));
    out += htmlText(text.substr(at, end - at)) + "\n";
    at = end + 1;
  }
  return out + "</pre>\n";
}

}  // namespace

std::string reportPage(const TaskResult& result, const Attempt& attempt, const std::vector<ReportPicture>& pictures) {
  const TaskConfig& task = result.task;
  const TaskStatus& status = result.status;
  const std::string title = htmlText(task.title.empty() ? task.name : task.title), state = nameOf(status.state);
  std::string out = pageHead(title) + "<h1>" + title + "</h1>\n<p><span class='state " + state + "'>" + state +
                    "</span> " + htmlText(verdictText(task, status)) + "</p>\n<p>" +
                    htmlText(mistakesText(task, status)) + "</p>\n" + attemptTable(result, attempt) +
                    plainBlock(task.instructions);
  out += "<p>Score = " + plainNumber(task.time_limit_s) + " &minus; " + plainNumber(status.time_s) +
         " (time in s) &minus; " + plainNumber(status.penalties_s) +
         " (cost of mistakes), at least 0. It is 0 if the goal was not reached. One point is one second." +
         (task.proficiency_s > 0 ? " A proficient user takes " + plainNumber(task.proficiency_s) + " s." : "") +
         "</p>\n";
  out += measureTable(result) + toolTable(result);
  for (const ReportPicture& picture : pictures) out += pictureHtml(picture);
  out += figure(result, "Paths of the tips near the work, over its lines (green); dots: cuts.", workPlot(result)) +
         figure(result, "Speed", speedPlot(result)) + figure(result, "Force", forcePlot(result));
  return out +
         "<p class='small'>Measures are defined in docs/lessons/tasks.md and docs/replay.md. Positions are in the "
         "tissue frame. Scores of experts (OSATS, GEARS) are not measured.</p></body></html>\n";
}

}  // namespace viscera
