// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/math/error.h"
#include "viscera/math/types.h"

namespace viscera {

// A task: what a trainee is to achieve in a scene, and how it is scored (docs/lessons/tasks.md). Every field of these
// structs has one entry in task_fields.h. Places are of the tissue at rest, in the tissue frame.

/// What has to be done: the rows of kTaskKinds (task_kinds.h), each with a group of keys of its own below.
enum class TaskGoal { kFollowLine, kCutDisc, kTouchTargets, kLift, kCloseWound, kClipDivide };

struct TaskPlace {
  Vector3d position_m = Vector3d::Zero();
};

/// Cut along a line, the blade within a corridor.
struct LineGoal {
  bool given = false;
  std::vector<TaskPlace> path;  ///< two places at least
  Vector3d normal = Vector3d::UnitZ();
  double corridor_m = 0.002;
  double share = 0.95;
};

/// Cut out a disc.
struct DiscGoal {
  bool given = false;
  Vector3d center_m = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitZ();
  double radius_m = 0.025;
  double corridor_m = 0.002;
};

/// Touch places of the tissue, one after another.
struct TouchGoal {
  bool given = false;
  std::vector<TaskPlace> targets;
  double radius_m = 0.005;
};

/// Take hold of tissue at a place, lift it and keep it there.
struct LiftGoal {
  bool given = false;
  Vector3d center_m = Vector3d::Zero();
  double radius_m = 0.008;
  Vector3d up = Vector3d::UnitZ();
  double height_m = 0.02;
  double hold_s = 1;
};

/// Open tissue along a line, and close the wound with the threads of the scene.
struct CloseGoal {
  bool given = false;
  LineGoal line;
  double reach_m = 0.003;
  double gap_m = 0.0005;
  int knots = 1;
  int throws = 3;
};

/// Clip tissue at two places or more, and divide it between the innermost two.
struct ClipGoal {
  bool given = false;
  std::vector<TaskPlace> clips;  ///< an even number, in their order along the tissue
  double radius_m = 0.003;
};

/// Beyond these, time is counted.
struct TaskLimits {
  double force_n = 1000;  ///< of any hand
  double strain = 1000;   ///< of any spring
};

/// What a measure (task_measures.h) costs, and up to where the task is passed.
struct TaskRule {
  std::string measure = "off_path_mm";
  double cost_s = 0;  ///< per unit of it
  double most = 1e9;
};

struct TaskConfig {
  std::string scene, title, instructions;
  TaskGoal kind = TaskGoal::kCutDisc;
  double time_limit_s = 300;
  double proficiency_s = 0;  ///< 0: not known
  double pass_score = 0;
  LineGoal line;
  DiscGoal disc;
  TouchGoal touch;
  LiftGoal lift;
  CloseGoal close;
  ClipGoal clip;
  TaskLimits limits;
  std::vector<TaskRule> measures;

  std::string name;  ///< of the file, without folder and .yaml
  std::string yaml;  ///< its text
};

/// A task's file is wrong. Names the file, the line, the key and what is accepted.
struct TaskError : Error {
  using Error::Error;
};

/// @throws TaskError
TaskConfig loadTask(const std::string& path);
/// The same from a text. @param where  its name, for errors and as the task's
TaskConfig parseTask(const std::string& yaml, const std::string& where);
/// Path, or name, of the scene of a task: its name, or what lies where the task's file does.
std::string sceneOfTask(const TaskConfig& task, const std::string& task_file);

/// The table of a task's keys, in Markdown, with those of kinds and measures.
std::string taskKeysTable();

}  // namespace viscera
