// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/task.h"

namespace viscera {
namespace {

/// Places positions relative to parts. Messages name the task and the key.
class Places {
 public:
  Places(const Model& model, const std::string& task) : model_(model), task_(task) {}

  void place(PartPosition& at, Vector3d& position_m, const std::string& key) const {
    if (!at.given) return;
    if (at.part.empty()) throw TaskError(task_ + ": '" + key + ".at' needs 'part', the name of a part of the tissue");
    try {
      position_m = positionOf(model_, at);
    } catch (const Error& error) {
      throw TaskError(task_ + ": '" + key + ".at': " + error.what());
    }
    at = {};
  }
  void place(std::vector<TaskPosition>& positions, const std::string& key) const {
    for (size_t i = 0; i < positions.size(); ++i)
      place(positions[i].at, positions[i].position_m, key + "[" + std::to_string(i) + "]");
  }
  void place(TaskGoals& goals, const std::string& group) const {
    place(goals.line.path, group + "follow_line.path");
    place(goals.touch.targets, group + "touch_targets.targets");
    place(goals.lift.at, goals.lift.center_m, group + "lift");
    place(goals.close.line.path, group + "close_wound.path");
    place(goals.clip.clips, group + "clip_and_divide.clips");
    place(goals.detach.at, goals.detach.position_m, group + "detach");
    place(goals.expose.places, group + "expose.places");
  }

 private:
  const Model& model_;
  const std::string task_;
};

}  // namespace

void placeTask(TaskConfig& task, const Model& model) {
  const Places places(model, task.name);
  places.place(task, "");
  std::vector<TaskStage>& stages = task.operation.stages;
  for (size_t i = 0; i < stages.size(); ++i) places.place(stages[i], "operation.stages[" + std::to_string(i) + "].");
}

}  // namespace viscera
