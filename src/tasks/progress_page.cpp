// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>

#include "tasks/plot.h"
#include "tasks/progress.h"
#include "tasks/verdict.h"

namespace viscera {

namespace {

using Scores = std::map<std::string, PlotPoints>;  // trainee to number of the attempt and score

constexpr double kProgressWide_px = 560, kProgressHigh_px = 220;
constexpr size_t kSolidCurves = 7;  // number of colors; further curves are dashed

std::string shownName(const std::string& trainee) {
  return trainee.empty() ? "no name" : htmlText(trainee);
}

/// Returns a path as a relative URL.
std::string urlOf(const std::filesystem::path& path) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string out;
  for (const char c : path.generic_string()) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x80 && std::isalnum(byte) != 0) || c == '/' || c == '.' || c == '_' || c == '-')
      out += c;
    else
      out += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
  }
  return "./" + out;
}

/// Returns a link to the page next to a report.json, or the plain text if there is none.
std::string linked(const AttemptResult& attempt, const std::string& folder, const std::string& text) {
  const std::filesystem::path page = std::filesystem::path(attempt.file).parent_path() / "report.html";
  std::error_code error;
  const std::filesystem::path relative = std::filesystem::relative(page, folder, error);
  if (error || relative.empty() || !std::filesystem::exists(page, error)) return text;
  return "<a href='" + urlOf(relative) + "'>" + text + "</a>";
}

std::string scorePlot(const Scores& scores, double pass_score) {
  double most = pass_score, attempts = 2;
  for (const auto& [trainee, points] : scores) {
    for (const auto& point : points) most = std::max(most, point.second);
    attempts = std::max(attempts, static_cast<double>(points.size()));
  }
  Plot plot({0, attempts + 1, "attempt"}, axisUpTo(1.05 * most, "score, points"), kProgressWide_px, kProgressHigh_px);
  if (pass_score > 0) plot.addLine({{0, pass_score}, {attempts + 1, pass_score}}, "#777", 1, "5 4");
  size_t index = 0;
  for (const auto& [trainee, points] : scores) {
    plot.addLine(points, plotColor(index), 1.5, index < kSolidCurves ? "" : "6 3");
    for (const auto& [attempt, score] : points) plot.addDot(attempt, score, plotColor(index), 3);
    ++index;
  }
  return plot.svg();
}

/// Returns the curves of a task. @param pass_score  of its last attempt
std::string taskFigure(const std::string& title, const Scores& scores, double pass_score) {
  std::string names;
  size_t index = 0;
  for (const auto& [trainee, points] : scores)
    names += " <span style='color:" + std::string(plotColor(index++)) + "'>&#9632; " + shownName(trainee) + "</span>";
  return "<figure><figcaption>" + title + names + (pass_score > 0 ? " (dashed: the score that passes)" : "") +
         "</figcaption>" + scorePlot(scores, pass_score) + "</figure>\n";
}

}  // namespace

std::string progressPage(const AttemptList& progress, const std::string& folder) {
  std::map<std::string, Scores> tasks;
  std::map<std::string, const AttemptResult*> last;
  std::string table =
      "<table class='attempts'><tr><th>date (UTC)</th><th>name</th><th>task</th><th>verdict</th><th>score, points</th>"
      "<th>time, s</th></tr>\n";
  for (const AttemptResult& attempt : progress.attempts) {
    PlotPoints& points = tasks[attempt.task][attempt.trainee];
    points.emplace_back(static_cast<double>(points.size() + 1), attempt.score);
    last[attempt.task] = &attempt;
    table += "<tr><td>" + linked(attempt, folder, htmlText(attempt.date)) + "</td><td>" + shownName(attempt.trainee) +
             "</td><td>" + htmlText(attempt.task) + "</td><td>" + attempt.state + "</td><td>" +
             plainNumber(attempt.score) + "</td><td>" + plainNumber(attempt.time_s) + "</td></tr>\n";
  }
  std::string out = pageHead("Progress") + "<h1>Progress</h1>\n<p>" + std::to_string(progress.attempts.size()) +
                    (progress.attempts.size() == 1 ? " attempt" : " attempts") + "; " +
                    std::to_string(progress.skipped.size()) + " files skipped.</p>\n";
  for (const auto& [task, scores] : tasks) {
    const AttemptResult& newest = *last[task];
    out += taskFigure(htmlText(newest.title.empty() ? task : newest.title), scores, newest.pass_score);
  }
  out += table + "</table>\n";
  if (!progress.skipped.empty()) {
    out += "<p>Skipped:</p><ul class='small'>\n";
    for (const std::string& file : progress.skipped) out += "<li>" + htmlText(file) + "</li>\n";
    out += "</ul>\n";
  }
  return out + "</body></html>\n";
}

}  // namespace viscera
