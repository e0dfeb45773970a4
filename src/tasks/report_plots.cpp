// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/report_plots.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "math/number_text.h"
#include "tasks/plot.h"
#include "tasks/task_kinds.h"

namespace viscera {

namespace {

using Box3d = Eigen::AlignedBox3d;

constexpr const char *kCutColor = "#222", *kLineColor = "#009e73";
constexpr double kPlotMm = 1000;
constexpr double kWide_px = 560, kHigh_px = 160, kSide_px = 380;
constexpr double kRoom = 1.25;  // extent of the plot of the work, relative to the work's
// Distance from the lines within which tools are at work, in extents of the lines.
constexpr double kNearInPlane = 0.25, kNearAlong = 1.5;
constexpr double kLeastExtent_m = 2e-3;
constexpr double kUpright = 0.7;  // share of z in a normal that is drawn upwards

/// Returns a plot of a number of each tool over time.
std::string timePlot(const TaskResult& result, const char* label,
                     const std::function<double(const ToolTrack&, size_t)>& value) {
  std::vector<PlotPoints> curves;
  double most = 0;
  const ToolRows& tools = result.tools;
  for (size_t s = 0; s < tools.styluses.size(); ++s) {
    const ToolTrack track = tools.track(s);
    curves.emplace_back();
    for (size_t i = 0; i < tools.rows.size(); ++i) {
      curves.back().emplace_back(static_cast<double>(i) * tools.tick_s, value(track, i));
      most = std::max(most, curves.back().back().second);
    }
  }
  const double end_s = std::max(tools.tick_s, static_cast<double>(tools.rows.size()) * tools.tick_s);
  Plot plot({0, end_s, "time, s"}, axisUpTo(most, label), kWide_px, kHigh_px);
  for (size_t s = 0; s < curves.size(); ++s) plot.addLine(curves[s], plotColor(s), 1.2);
  return plot.svg();
}

double speedAt(const ToolTrack& track, size_t i) {
  if (i == 0 || !track.tracked[i] || !track.tracked[i - 1]) return 0;
  return (track.positions_m[i] - track.positions_m[i - 1]).norm() * track.rate_hz;
}

double forceAt(const ToolTrack& track, size_t i) {
  return i < track.forces_n.size() && track.forces_n[i].allFinite() ? track.forces_n[i].norm() : 0;
}

/// Returns the positions of tracked tips, per stylus.
std::vector<std::vector<Vector3d>> pathsOf(const TaskResult& result) {
  std::vector<std::vector<Vector3d>> out;
  for (size_t s = 0; s < result.tools.styluses.size(); ++s) {
    const ToolTrack track = result.tools.track(s);
    out.emplace_back();
    for (size_t i = 0; i < track.positions_m.size(); ++i)
      if (track.tracked[i]) out.back().push_back(track.positions_m[i]);
  }
  return out;
}

/// Returns lines, cut points and the positions of tips near them.
std::vector<Vector3d> workPoints(const TaskResult& result, const TaskShapes& shapes) {
  std::vector<Vector3d> out;
  Box3d box;
  for (const auto& line : shapes.lines_m) {
    for (const Vector3d& position : line) {
      box.extend(position);
      out.push_back(position);
    }
  }
  if (box.isEmpty()) return out;
  const double near_m =
      (shapes.along_normal ? kNearAlong : kNearInPlane) * std::max(kLeastExtent_m, box.sizes().maxCoeff());
  const auto add = [&](const Vector3d& position) {
    if (box.exteriorDistance(position) <= near_m) out.push_back(position);
  };
  for (const auto& path : pathsOf(result)) std::for_each(path.begin(), path.end(), add);
  std::for_each(result.cuts_m.begin(), result.cuts_m.end(), add);
  return out;
}

double spread(const std::vector<Vector3d>& points, const Vector3d& along) {
  double low = 0, high = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const double at = along.dot(points[i]);
    low = i == 0 ? at : std::min(low, at);
    high = i == 0 ? at : std::max(high, at);
  }
  return high - low;
}

/// Names an axis: that of the tissue frame, if it is one.
std::string axisName(const Vector3d& axis) {
  constexpr const char* kNames[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    if (axis[k] > 1 - 1e-9) return kNames[k];
    if (axis[k] < -1 + 1e-9) return std::string("-") + kNames[k];
  }
  const auto number = [&](int k) { return numberText(std::round(100 * axis[k]) / 100, 2); };
  return "along (" + number(0) + ", " + number(1) + ", " + number(2) + ")";
}

}  // namespace

WorkPlane workPlane(const TaskResult& result) {
  const TaskShapes shapes = kindOf(result.task.kind).shapes(result.task);
  const std::vector<Vector3d> points = workPoints(result, shapes);
  const Vector3d normal = shapes.normal.normalized();
  Vector3d first = Vector3d::UnitX() - normal * normal.x();
  if (first.norm() < 0.1) first = Vector3d::UnitY() - normal * normal.y();
  first.normalize();
  const Vector3d second = normal.cross(first);
  WorkPlane out{first, second, {}, {}};
  if (shapes.along_normal) {
    const Vector3d across = spread(points, first) >= spread(points, second) ? first : second;
    const bool upright = std::abs(normal.z()) > kUpright;
    out.right = upright ? across : normal;
    out.up = upright ? normal : across;
  }
  Eigen::AlignedBox2d box;
  for (const Vector3d& point : points) box.extend(Eigen::Vector2d(out.right.dot(point), out.up.dot(point)));
  if (box.isEmpty()) box.extend(Eigen::Vector2d(0, 0));
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(kRoom / 2 * std::max(kLeastExtent_m, box.sizes().maxCoeff()));
  out.low = box.center() - half;
  out.high = box.center() + half;
  return out;
}

std::string workPlot(const TaskResult& result) {
  const WorkPlane plane = workPlane(result);
  Plot plot({kPlotMm * plane.low.x(), kPlotMm * plane.high.x(), axisName(plane.right) + ", mm"},
            {kPlotMm * plane.low.y(), kPlotMm * plane.high.y(), axisName(plane.up) + ", mm"}, kSide_px, kSide_px);
  const auto flat = [&](const std::vector<Vector3d>& positions) {
    PlotPoints out;
    for (const Vector3d& position : positions)
      out.emplace_back(kPlotMm * plane.right.dot(position), kPlotMm * plane.up.dot(position));
    return out;
  };
  for (const auto& line : kindOf(result.task.kind).shapes(result.task).lines_m) plot.addLine(flat(line), kLineColor, 3);
  const std::vector<std::vector<Vector3d>> paths = pathsOf(result);
  for (size_t s = 0; s < paths.size(); ++s) plot.addLine(flat(paths[s]), plotColor(s), 0.8);
  for (const auto& [x, y] : flat(result.cuts_m)) plot.addDot(x, y, kCutColor, 1.5);
  return plot.svg();
}

std::string speedPlot(const TaskResult& result) {
  return timePlot(result, "speed of the tip, m/s", speedAt);
}

std::string forcePlot(const TaskResult& result) {
  return timePlot(result, "force, N", forceAt);
}

}  // namespace viscera
