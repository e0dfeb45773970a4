// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tasks/task_watch.h"

namespace viscera {

/// Axes of the plot of the work, in the tissue frame.
struct WorkPlane {
  Vector3d right, up;         ///< unit vectors
  Eigen::Vector2d low, high;  ///< range along them, with the same extent [m]
};
/// Returns the plane of the task's lines, or where the work goes along their normal, the plane of the normal and of the
/// direction across it in which the tools moved farther near the lines.
WorkPlane workPlane(const TaskResult& result);

/// Returns the paths of the tips, the lines of the task and the cut points in workPlane(), as SVG.
std::string workPlot(const TaskResult& result);
/// Returns the speed of each tip over time, as SVG.
std::string speedPlot(const TaskResult& result);
/// Returns the force on each tool over time, as SVG.
std::string forcePlot(const TaskResult& result);

}  // namespace viscera
