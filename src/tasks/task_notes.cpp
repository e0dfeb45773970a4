// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/task_notes.h"

#include <algorithm>

#include "tasks/task_kinds.h"
#include "tasks/task_measures.h"

namespace viscera {

namespace {

/// Measure that only some kinds count; the others are counted in every task.
struct MeasureOfKind {
  std::string_view measure;
  TaskGoal goal;
};
constexpr MeasureOfKind kOfKinds[] = {
    {"off_path_mm", TaskGoal::kFollowLine},     {"off_path_mm", TaskGoal::kCutDisc},
    {"off_path_mm", TaskGoal::kCloseWound},     {"deviation_mm", TaskGoal::kFollowLine},
    {"deviation_mm", TaskGoal::kCutDisc},       {"deviation_mm", TaskGoal::kCloseWound},
    {"wrong_touches", TaskGoal::kTouchTargets}, {"drops", TaskGoal::kLift},
    {"gap_mm", TaskGoal::kCloseWound},          {"weak_knots", TaskGoal::kCloseWound},
    {"clip_off_mm", TaskGoal::kClipDivide},     {"bad_clips", TaskGoal::kClipDivide},
};

/// Returns whether tasks of a kind count a measure (task_measures.h).
bool isOfKind(std::string_view measure, TaskGoal goal) {
  bool of_kinds = false;
  for (const MeasureOfKind& row : kOfKinds) {
    if (row.measure != measure) continue;
    if (row.goal == goal) return true;
    of_kinds = true;
  }
  return !of_kinds;
}

}  // namespace

bool isCounted(std::string_view measure, const TaskConfig& task) {
  if (measure == kSparedCuts) return !task.spared_parts.empty();
  if (task.kind != TaskGoal::kOperation) return isOfKind(measure, task.kind);
  const std::vector<TaskStage>& stages = task.operation.stages;
  return std::any_of(stages.begin(), stages.end(),
                     [&](const TaskStage& stage) { return isOfKind(measure, stage.kind); });
}

std::vector<std::string> taskNotes(const TaskConfig& task) {
  std::vector<std::string> notes;
  for (const TaskRule& rule : task.measures) {
    if (isCounted(rule.measure, task)) continue;
    std::string counted;
    for (const TaskMeasure& measure : kTaskMeasures)
      if (isCounted(measure.name, task)) counted += (counted.empty() ? "" : ", ") + std::string(measure.name);
    notes.push_back("measure " + rule.measure + " is always 0 in a task of kind " + kindOf(task.kind).name +
                    ", which measures " + counted);
  }
  return notes;
}

}  // namespace viscera
