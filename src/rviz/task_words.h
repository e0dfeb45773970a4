// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QString>
#include <string>
#include <vector>

namespace viscera::rviz_plugin {

/// A measure of a task, as in `viscera/TaskState`.
struct SentMeasure {
  std::string name;
  double value = 0, cost_s = 0;
};

/// Describes the measures of a task, a line for each: those of its kind, and any other with a cost.
/// @param kind  kind of the task, as in viscera/TaskState
QString measuresText(const std::string& kind, const std::vector<SentMeasure>& measures);

/// A task's score as a bar.
struct ScoreBar {
  double share = 0, pass_share = 0;  ///< of the bar: the score, and the lowest one that passes; 0..1
  bool passes = false;
  QString text;
};
/// @param most  score of a task that takes no time: its time limit
ScoreBar scoreBar(double score, double pass_score, double most);

/// Returns whether the measure has a description of its own.
bool hasWords(const std::string& measure);

}  // namespace viscera::rviz_plugin
