// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tasks/task_watch.h"

namespace viscera {

/// Returns a number for a person: three significant digits or one decimal, whichever is more.
std::string plainNumber(double value);
/// Returns a number and its unit. @param unit  empty: none
std::string withUnit(double value, const std::string& unit);
/// Returns the noun of a measure, with the limits of the task, as in "force above 2 N".
std::string phraseOf(const TaskConfig& task, const TaskMeasure& measure);
/// Returns the goal of a task as an imperative, as in "cut 95 % of the line".
std::string goalText(const TaskConfig& task);

/// Returns the largest value of a measure with which the task is passed, or nothing if it has no such limit.
std::optional<double> mostOf(const TaskConfig& task, const TaskMeasure& measure);
/// Returns the limit that an ended task failed: time_limit_s, a measure, pass_score, or empty if it was passed or given
/// up.
std::string failedLimit(const TaskConfig& task, const TaskStatus& status);
/// Returns whether an ended task failed the limit of a measure, whichever limit decided it.
bool isExceeded(const TaskConfig& task, const TaskTally& tally, const TaskMeasure& measure);

/// Returns one sentence or two that say whether a task was passed, why, and with which score.
std::string verdictText(const TaskConfig& task, const TaskStatus& status);
/// Returns a sentence with the mistakes that cost most, three at most.
std::string mistakesText(const TaskConfig& task, const TaskStatus& status);

}  // namespace viscera
