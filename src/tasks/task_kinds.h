// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "tasks/task.h"
#include "tasks/task_judge.h"

namespace viscera {

class Session;

/// One kind of task, with everything that the rest of the program needs to know of it.
struct TaskKind {
  TaskGoal goal;
  const char* name;  ///< name in files; also of the group with its keys
  /// Returns why a task of this kind cannot be judged, as 'key' is ..., or empty.
  std::string (*fault)(const TaskConfig&);
  std::unique_ptr<TaskJudge> (*judge)(const TaskConfig&, const Session&);
  /// Returns what is to be cut, touched or lifted, for drawing: polylines [m].
  TaskShapes (*shapes)(const TaskConfig&);
};

std::string lineFault(const TaskConfig&);
std::unique_ptr<TaskJudge> lineJudge(const TaskConfig&, const Session&);
TaskShapes lineShapes(const TaskConfig&);
std::string discFault(const TaskConfig&);
std::unique_ptr<TaskJudge> discJudge(const TaskConfig&, const Session&);
TaskShapes discShapes(const TaskConfig&);
std::string touchFault(const TaskConfig&);
std::unique_ptr<TaskJudge> touchJudge(const TaskConfig&, const Session&);
TaskShapes touchShapes(const TaskConfig&);
std::string liftFault(const TaskConfig&);
std::unique_ptr<TaskJudge> liftJudge(const TaskConfig&, const Session&);
TaskShapes liftShapes(const TaskConfig&);

std::string closeFault(const TaskConfig&);
std::unique_ptr<TaskJudge> closeJudge(const TaskConfig&, const Session&);
TaskShapes closeShapes(const TaskConfig&);

std::string clipFault(const TaskConfig&);
std::unique_ptr<TaskJudge> clipJudge(const TaskConfig&, const Session&);
TaskShapes clipShapes(const TaskConfig&);

std::string detachFault(const TaskConfig&);
std::unique_ptr<TaskJudge> detachJudge(const TaskConfig&, const Session&);
TaskShapes detachShapes(const TaskConfig&);

std::string exposeFault(const TaskConfig&);
std::unique_ptr<TaskJudge> exposeJudge(const TaskConfig&, const Session&);
TaskShapes exposeShapes(const TaskConfig&);

std::string operationFault(const TaskConfig&);
std::unique_ptr<TaskJudge> operationJudge(const TaskConfig&, const Session&);
TaskShapes operationShapes(const TaskConfig&);
/// Returns a stage of a task as a task of its own, with the task's name.
TaskConfig stageOf(const TaskConfig& task, const TaskStage& stage);

/// Returns the judge for kinds that include cutting along a line.
std::unique_ptr<TaskJudge> judgeOfLine(const LineGoal& line, double spacing_m);
/// Returns the fault of a line, or empty. @param group  of its keys
std::string faultOfLine(const LineGoal& line, const std::string& group);
TaskShapes shapesOfLine(const LineGoal& line);

inline constexpr TaskKind kTaskKinds[] = {
    {TaskGoal::kFollowLine, "follow_line", lineFault, lineJudge, lineShapes},
    {TaskGoal::kCutDisc, "cut_disc", discFault, discJudge, discShapes},
    {TaskGoal::kTouchTargets, "touch_targets", touchFault, touchJudge, touchShapes},
    {TaskGoal::kLift, "lift", liftFault, liftJudge, liftShapes},
    {TaskGoal::kCloseWound, "close_wound", closeFault, closeJudge, closeShapes},
    {TaskGoal::kClipDivide, "clip_and_divide", clipFault, clipJudge, clipShapes},
    {TaskGoal::kDetach, "detach", detachFault, detachJudge, detachShapes},
    {TaskGoal::kExpose, "expose", exposeFault, exposeJudge, exposeShapes},
    {TaskGoal::kOperation, "operation", operationFault, operationJudge, operationShapes},
};
constexpr const TaskKind& kindOf(TaskGoal goal) {
  return kTaskKinds[static_cast<size_t>(goal)];
}

}  // namespace viscera
