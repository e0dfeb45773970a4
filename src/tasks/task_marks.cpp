// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/task_marks.h"

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

struct StateStyle {
  double red, green, blue;
  MarkPattern pattern;
};
/// In the order of MarkState; colours of Okabe and Ito's set: white, yellow, sky blue, vermillion.
constexpr StateStyle kStateStyles[] = {{0.95, 0.95, 0.95, MarkPattern::kThin},
                                       {0.94, 0.89, 0.26, MarkPattern::kDashed},
                                       {0.34, 0.71, 0.91, MarkPattern::kDouble},
                                       {0.84, 0.37, 0.00, MarkPattern::kCrossed}};
constexpr double kTargetWidth = 0.16;  // of a target's lines, over its radius

/// Returns the corners of a path, with its length across the normal up to each.
std::vector<double> lengthsAlong(const std::vector<Vector3d>& path_m, const Vector3d& normal) {
  const Vector3d up = normal.normalized();
  std::vector<double> out = {0};
  for (size_t i = 1; i < path_m.size(); ++i) {
    const Vector3d offset_m = path_m[i] - path_m[i - 1];
    out.push_back(out.back() + (offset_m - up * up.dot(offset_m)).norm());
  }
  return out;
}

Vector3d positionAt(const std::vector<Vector3d>& path_m, const std::vector<double>& along_m, double at_m) {
  for (size_t i = 1; i < path_m.size(); ++i) {
    const double step_m = along_m[i] - along_m[i - 1];
    if (at_m <= along_m[i] && step_m > 0)
      return path_m[i - 1] + std::max(0.0, at_m - along_m[i - 1]) / step_m * (path_m[i] - path_m[i - 1]);
  }
  return path_m.back();
}

}  // namespace

std::vector<MarkConfig> styledMarks(std::vector<MarkConfig> marks, const std::vector<MarkState>& states) {
  for (size_t i = 0; i < std::min(marks.size(), states.size()); ++i) {
    const StateStyle& style = kStateStyles[static_cast<size_t>(states[i])];
    marks[i].color = {style.red, style.green, style.blue};
    marks[i].pattern = style.pattern;
  }
  return marks;
}

std::vector<MarkConfig> lineInPieces(const std::vector<Vector3d>& path_m, const Vector3d& normal, size_t count,
                                     double width_m) {
  const std::vector<double> along_m = lengthsAlong(path_m, normal);
  std::vector<MarkConfig> out(count);
  for (size_t piece = 0; piece < count; ++piece) {
    const double from_m = along_m.back() * static_cast<double>(piece) / static_cast<double>(count);
    const double to_m = along_m.back() * static_cast<double>(piece + 1) / static_cast<double>(count);
    MarkConfig& mark = out[piece];
    mark.normal = normal;
    mark.width_m = width_m;
    mark.path.push_back({positionAt(path_m, along_m, from_m)});
    for (size_t i = 0; i < path_m.size(); ++i)
      if (along_m[i] > from_m && along_m[i] < to_m) mark.path.push_back({path_m[i]});
    mark.path.push_back({positionAt(path_m, along_m, to_m)});
  }
  return out;
}

MarkConfig targetMark(const Vector3d& center_m, const Vector3d& normal, double radius_m) {
  MarkConfig out;
  out.kind = MarkKind::kTarget;
  out.center_m = center_m;
  out.normal = normal;
  out.radius_m = radius_m;
  out.width_m = kTargetWidth * radius_m;
  return out;
}

MarkConfig ringMark(const Vector3d& center_m, const Vector3d& normal, double within_m, double width_m) {
  MarkConfig out;
  out.kind = MarkKind::kRing;
  out.center_m = center_m;
  out.normal = normal;
  out.radius_m = within_m;
  out.width_m = width_m;
  return out;
}

}  // namespace viscera
