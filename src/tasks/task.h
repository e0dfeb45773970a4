// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/math/error.h"
#include "viscera/math/types.h"
#include "viscera/model/part_position.h"

namespace viscera {

struct Model;

// A task: what a trainee has to achieve in a scene, and how it is scored (docs/lessons/tasks.md). Every field of these
// structs has one entry in task_fields.h. Positions are in the rest shape of the tissue, in the tissue frame.

/// Goal of a task: the rows of kTaskKinds (task_kinds.h), each with a group of keys of its own below.
enum class TaskGoal {
  kFollowLine,
  kCutDisc,
  kTouchTargets,
  kLift,
  kCloseWound,
  kClipDivide,
  kDetach,
  kExpose,
  kOperation
};

/// Position in the tissue at rest.
struct TaskPosition {
  Vector3d position_m = Vector3d::Zero();
  PartPosition at;  ///< position relative to a part instead, until placeTask()
};

/// Cut along a line, with the blade within a corridor.
struct LineGoal {
  bool given = false;
  std::vector<TaskPosition> path;  ///< at least two positions
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

/// Touch positions of the tissue, one after another.
struct TouchGoal {
  bool given = false;
  std::vector<TaskPosition> targets;
  double radius_m = 0.005;
};

/// Grasp tissue at a position, lift it and keep it there.
struct LiftGoal {
  bool given = false;
  Vector3d center_m = Vector3d::Zero();
  PartPosition at;  ///< as TaskPosition::at
  double radius_m = 0.008;
  Vector3d up = Vector3d::UnitZ();
  double height_m = 0.02;
  double hold_s = 1;
};

/// Open tissue along a line, and close the wound with the sutures of the scene.
struct CloseGoal {
  bool given = false;
  LineGoal line;
  double reach_m = 0.003;
  double gap_m = 0.0005;
  int knots = 1;
  int throws = 3;
};

/// Clip tissue at two or more positions, and divide it between two of them.
struct ClipGoal {
  bool given = false;
  std::vector<TaskPosition> clips;  ///< in their order along the tissue
  int divide_after = 0;             ///< number of clips before the division; 0: half of them
  std::string part;                 ///< part that is clipped, for tissue that is joined elsewhere too; empty: all
  double radius_m = 0.003;

  size_t before() const { return divide_after > 0 ? static_cast<size_t>(divide_after) : clips.size() / 2; }
};

/// Cut tissue until no path leads from a position to tissue that is held in space.
struct DetachGoal {
  bool given = false;
  Vector3d position_m = Vector3d::Zero();
  PartPosition at;  ///< as TaskPosition::at
};

/// Free tissue from what attachments join it to.
struct ExposeGoal {
  bool given = false;
  std::vector<TaskPosition> places;
  double radius_m = 0.006;
  double share = 0.9;
};

/// Kind of a goal with the keys of all kinds.
struct TaskGoals {
  TaskGoal kind = TaskGoal::kCutDisc;
  LineGoal line;
  DiscGoal disc;
  TouchGoal touch;
  LiftGoal lift;
  CloseGoal close;
  ClipGoal clip;
  DetachGoal detach;
  ExposeGoal expose;
};

/// One stage of an operation: a goal of any other kind.
struct TaskStage : TaskGoals {
  std::string title;
};

/// Reach the goals of stages, one after another.
struct OperationGoal {
  bool given = false;
  std::vector<TaskStage> stages;
};

/// Limits above which time is counted.
struct TaskLimits {
  double force_n = 1000;  ///< force on any tool [N]
  double strain = 1000;   ///< strain of any spring
};

/// Cost of a measure (task_measures.h), and the largest value with which the task is passed.
struct TaskRule {
  std::string measure = "off_path_mm";
  double cost_s = 0;  ///< cost per unit of the measure [s]
  double most = 1e9;
};

struct TaskConfig : TaskGoals {
  std::string scene, title, instructions;
  double time_limit_s = 300;
  double proficiency_s = 0;  ///< time of a proficient user [s]; 0: unknown
  double pass_score = 0;
  OperationGoal operation;
  std::vector<std::string> spared_parts;  ///< names of parts or bodies that must not be cut
  TaskLimits limits;
  std::vector<TaskRule> measures;

  std::string name;  ///< name of the file, without folder and .yaml
  std::string yaml;  ///< text of the file
};

/// Error in a task's file. Names the file, the line, the key and what is accepted.
struct TaskError : Error {
  using Error::Error;
};

/// Reads a task's file. @throws TaskError  what is wrong
TaskConfig loadTask(const std::string& path);
/// Reads a task from text. @param where  its name, for errors and as the task's name
TaskConfig parseTask(const std::string& yaml, const std::string& where);
/// Gives positions relative to parts their places in a model. @throws TaskError  the model has no such part
void placeTask(TaskConfig& task, const Model& model);
/// Returns the path or name of a task's scene: its name, or a file in the folder of the task's file.
std::string sceneOfTask(const TaskConfig& task, const std::string& task_file);

/// Returns a Markdown table of a task's keys, with those of kinds and measures.
std::string taskKeysTable();

}  // namespace viscera
