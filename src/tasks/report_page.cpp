// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/report_page.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>

#include "math/number_text.h"
#include "tasks/task_kinds.h"

namespace viscera {

namespace {

using Points = std::vector<std::pair<double, double>>;

constexpr const char* kStyle = R"(body{font:15px/1.45 system-ui,sans-serif;margin:2em auto;padding:0 1em;max-width:60em}
h1{margin:0}.state{display:inline-block;padding:.2em .8em;border-radius:.3em;color:#fff;font-weight:600}
.passed{background:#18794e}.failed{background:#b42318}.waiting,.running{background:#777}
table{border-collapse:collapse;margin:.6em 0}td,th{border-bottom:1px solid #ddd;padding:.2em .8em;text-align:right}
td:first-child,th:first-child{text-align:left}svg{background:#fafafa;border:1px solid #ddd}
svg text{font:12px system-ui,sans-serif;fill:#444}figure{display:inline-block;margin:.5em 1em .5em 0}img{max-width:28em}
pre{white-space:pre-wrap;font:inherit}.small{color:#666;font-size:13px})";
constexpr const char* kHandColors[] = {"#0072b2", "#d55e00"};  // Okabe and Ito
constexpr const char *kCutColor = "#222", *kLineColor = "#009e73";
constexpr size_t kMostPoints = 1500;  // points of a curve: more would not be visible
constexpr double kWide = 640, kHigh = 220, kMargin = 62;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string shortNumber(double value) {
  return numberText(value, 4);
}

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) out += i + k < bytes.size() + 1 ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

/// Range of a plot's data, and its size; y upwards.
struct Frame2d {
  double left, right, bottom, top, wide, high;
  std::pair<double, double> at(double x, double y) const {
    return {kMargin + (x - left) / (right - left) * (wide - 2 * kMargin),
            high - kMargin + (bottom - y) / (top - bottom) * (high - 2 * kMargin)};
  }
};

std::string polyline(const Frame2d& frame, const Points& points, const std::string& color, double width) {
  std::string out = "<polyline fill='none' stroke='" + color + "' stroke-width='" + shortNumber(width) + "' points='";
  const size_t every = std::max<size_t>(1, points.size() / kMostPoints);
  for (size_t i = 0; i < points.size(); i += every) {
    const auto [x, y] = frame.at(points[i].first, points[i].second);
    out += shortNumber(x) + "," + shortNumber(y) + " ";
  }
  return out + "'/>";
}

std::string label(double x, double y, const std::string& text, const char* anchor = "middle") {
  return "<text x='" + shortNumber(x) + "' y='" + shortNumber(y) + "' text-anchor='" + anchor + "'>" + escaped(text) +
         "</text>";
}

std::string svg(double wide, double high, const std::string& inside) {
  return "<svg xmlns='http://www.w3.org/2000/svg' width='" + shortNumber(wide) + "' height='" + shortNumber(high) +
         "'>" + inside + "</svg>\n";
}

std::string axes(const Frame2d& frame, const std::string& x, const std::string& y) {
  std::string out =
      polyline(frame, {{frame.left, frame.top}, {frame.left, frame.bottom}, {frame.right, frame.bottom}}, "#999", 1);
  const double low = frame.high - kMargin + 16;
  out += label(kMargin, low, shortNumber(frame.left)) + label(frame.wide - kMargin, low, shortNumber(frame.right));
  out += label(kMargin - 5, frame.high - kMargin, shortNumber(frame.bottom), "end");
  out += label(kMargin - 5, kMargin + 4, shortNumber(frame.top), "end");
  return out + label(frame.wide / 2, frame.high - 10, x) + label(kMargin, kMargin - 14, y, "start");
}

std::string handLegend(const TaskResult& result, double wide) {
  std::string out;
  for (size_t s = 0; s < result.hands.styluses.size(); ++s)
    out += "<tspan fill='" + std::string(kHandColors[s % 2]) + "'>" + escaped(result.hands.styluses[s]) + " </tspan>";
  return "<text x='" + shortNumber(wide - kMargin) + "' y='" + shortNumber(kMargin - 14) + "' text-anchor='end'>" +
         out + "</text>";
}

/// Returns a plot of a number of each tool over time.
std::string timePlot(const TaskResult& result, const char* title,
                     const std::function<double(const ToolTrack&, size_t)>& value) {
  std::vector<Points> curves;
  double most = 0;
  const ToolRows& hands = result.hands;
  for (size_t s = 0; s < hands.styluses.size(); ++s) {
    const ToolTrack track = hands.track(s);
    curves.emplace_back();
    for (size_t i = 0; i < hands.rows.size(); ++i) {
      curves.back().emplace_back(static_cast<double>(i) * hands.tick_s, value(track, i));
      most = std::max(most, curves.back().back().second);
    }
  }
  const double end_s = std::max(hands.tick_s, static_cast<double>(hands.rows.size()) * hands.tick_s);
  const Frame2d frame{0, end_s, 0, most > 0 ? most : 1, kWide, kHigh};
  std::string out = axes(frame, "s", title) + handLegend(result, kWide);
  for (size_t s = 0; s < curves.size(); ++s) out += polyline(frame, curves[s], kHandColors[s % 2], 1.2);
  return svg(kWide, kHigh, out);
}

double speedAt(const ToolTrack& track, size_t i) {
  if (i == 0 || !track.tracked[i] || !track.tracked[i - 1]) return 0;
  return (track.places_m[i] - track.places_m[i - 1]).norm() * track.rate_hz;
}

double forceAt(const ToolTrack& track, size_t i) {
  return i < track.forces_n.size() && track.forces_n[i].allFinite() ? track.forces_n[i].norm() : 0;
}

/// Returns a map seen along the normal of the task: the line, paths of the tips, and positions of cut springs.
std::string mapPlot(const TaskResult& result) {
  constexpr double kMm = 1000, kSide = 460, kRoom = 1.5;
  const TaskShapes shapes = kindOf(result.task.kind).shapes(result.task);
  const Vector3d up = shapes.normal.normalized();
  Vector3d x = Vector3d::UnitX() - up * up.x();
  if (x.norm() < 0.1) x = Vector3d::UnitY() - up * up.y();
  x.normalize();
  const Vector3d y = up.cross(x);
  const auto flat = [&](const Vector3d& place) { return std::make_pair(kMm * x.dot(place), kMm * y.dot(place)); };
  Eigen::AlignedBox2d box;
  for (const auto& line : shapes.lines_m)
    for (const Vector3d& place : line) box.extend(Eigen::Vector2d(flat(place).first, flat(place).second));
  const double half = std::max(1.0, kRoom * box.sizes().maxCoeff() / 2);
  const Eigen::Vector2d middle = box.center();
  const Frame2d frame{middle.x() - half, middle.x() + half, middle.y() - half, middle.y() + half, kSide, kSide};
  const std::string side = shortNumber(kSide - 2 * kMargin), edge = shortNumber(kMargin);
  std::string inside = "<clipPath id='map'><rect x='" + edge + "' y='" + edge + "' width='" + side + "' height='" +
                       side + "'/></clipPath><g clip-path='url(#map)'>";
  for (const auto& line : shapes.lines_m) {
    Points points;
    for (const Vector3d& place : line) points.push_back(flat(place));
    inside += polyline(frame, points, kLineColor, 3);
  }
  for (size_t s = 0; s < result.hands.styluses.size(); ++s) {
    const ToolTrack track = result.hands.track(s);
    Points points;
    for (size_t i = 0; i < track.places_m.size(); ++i)
      if (track.tracked[i]) points.push_back(flat(track.places_m[i]));
    inside += polyline(frame, points, kHandColors[s % 2], 0.8);
  }
  for (const Vector3d& cut : result.cuts_m) {
    const auto [px, py] = frame.at(flat(cut).first, flat(cut).second);
    inside += "<circle cx='" + shortNumber(px) + "' cy='" + shortNumber(py) + "' r='1.5' fill='" + kCutColor + "'/>";
  }
  return svg(kSide, kSide,
             inside + "</g>" + axes(frame, "mm", "mm, seen along the normal") + handLegend(result, kSide));
}

std::string measureTable(const TaskResult& result) {
  std::string out = "<table><tr><th>measure</th><th>value</th><th>costs, s</th></tr>\n";
  for (const TaskMeasure& measure : kTaskMeasures) {
    out += "<tr><td title='" + escaped(measure.meaning) + "'>" + measure.name + "</td><td>" +
           shortNumber(result.status.tally.*measure.value) + "</td><td>" +
           shortNumber(costOf(result.task, result.status.tally, measure)) + "</td></tr>\n";
  }
  return out + "</table>\n";
}

std::string handTable(const TaskResult& result) {
  const nlohmann::ordered_json hands = result.hands.metrics();
  std::string out = "<table><tr><th>hand</th>";
  for (const auto& hand : hands) out += "<th>" + escaped(hand["stylus"].get<std::string>()) + "</th>";
  out += "</tr>\n";
  const nlohmann::ordered_json first = hands.empty() ? nlohmann::ordered_json::object() : hands[0];
  for (const auto& [name, unused] : first.items()) {
    if (!unused.is_number()) continue;
    out += "<tr><td>" + name + "</td>";
    for (const auto& hand : hands) out += "<td>" + shortNumber(hand[name].get<double>()) + "</td>";
    out += "</tr>\n";
  }
  return out + "</table>\n";
}

std::string pictureHtml(const ReportPicture& picture) {
  std::ifstream file(picture.file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file || bytes.empty()) throw Error(picture.file + ": cannot be read for the report");
  return "<figure><img alt='" + escaped(picture.caption) + "' src='data:image/png;base64," + base64(bytes) +
         "'><figcaption>" + escaped(picture.caption) + "</figcaption></figure>\n";
}

}  // namespace

std::string reportPage(const TaskResult& result, const std::vector<ReportPicture>& pictures) {
  const TaskConfig& task = result.task;
  const TaskStatus& status = result.status;
  const std::string title = escaped(task.title.empty() ? task.name : task.title), state = nameOf(status.state);
  std::string out = "<!doctype html><html lang='en'><head><meta charset='utf-8'><title>" + title + "</title><style>" +
                    kStyle + "</style></head><body>\n<h1>" + title + "</h1>\n<p><span class='state " + state + "'>" +
                    state + "</span> " + escaped(status.step) + "</p>\n<pre>" + escaped(task.instructions) + "</pre>\n";
  out += "<p><b>Score " + shortNumber(status.score) + "</b> = " + shortNumber(task.time_limit_s) + " s &minus; " +
         shortNumber(status.time_s) + " s &minus; penalties of " + shortNumber(status.penalties_s) +
         " s, at least 0; it is 0 if the goal was not reached; " + shortNumber(task.pass_score) +
         " or more passes. Goal reached by " + shortNumber(100 * status.progress) + " %." +
         (task.proficiency_s > 0 ? " A proficient user takes " + shortNumber(task.proficiency_s) + " s." : "") +
         "</p>\n";
  out += measureTable(result) + handTable(result);
  for (const ReportPicture& picture : pictures) out += pictureHtml(picture);
  out += mapPlot(result) + timePlot(result, "speed of the tip, m/s", speedAt) + timePlot(result, "force, N", forceAt);
  return out +
         "<p class='small'>Measures are defined in docs/lessons/tasks.md and docs/replay.md. Scores of experts "
         "(OSATS, GEARS) are not measured.</p></body></html>\n";
}

}  // namespace viscera
