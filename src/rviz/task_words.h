// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QString>
#include <string>
#include <vector>

namespace viscera::rviz_plugin {

/// Value of a measure of a task, as `viscera/TaskState` has it.
struct SentMeasure {
  std::string name;
  double value = 0, cost_s = 0;
};

/// Writes the measures of a task in words, a line for each: those that its kind has, and any other that costs.
/// @param kind  of the task, as in viscera/TaskState
QString measuresText(const std::string& kind, const std::vector<SentMeasure>& measures);

/// Returns whether the measure has words of its own.
bool hasWords(const std::string& measure);

}  // namespace viscera::rviz_plugin
