// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/cut_watch.h"
#include "tasks/task_kinds.h"
#include "viscera/session/session.h"

namespace viscera {

namespace {

constexpr double kDetachMark_m = 0.003;  ///< radius of the mark at the position

class DetachJudge : public TaskJudge {
 public:
  DetachJudge(const DetachGoal& goal, const Model& model) : goal_(goal), piece_(model, goal.position_m) {}
  bool usesCuts() const override { return true; }
  bool judgesAlways() const override { return true; }
  bool usesFibres() const override { return true; }
  uint32_t piecesApart(const CutState& cuts, const std::vector<FibreState>& fibres) const override {
    return piece_.isApart(cuts, fibres) ? 1 : 0;
  }
  void judge(const TaskTick& tick, TaskTally&) override { apart_ = apart_ || tick.apart != 0; }
  double progress() const override { return apart_ ? 1 : 0; }
  bool reached() const override { return apart_; }
  std::string step() const override { return "cut the marked tissue free from what holds it"; }
  std::vector<MarkConfig> marks() const override {
    return {targetMark(goal_.position_m, Vector3d::Zero(), kDetachMark_m)};
  }
  std::vector<MarkState> markStates() const override { return {apart_ ? MarkState::kDone : MarkState::kNext}; }

 private:
  const DetachGoal goal_;
  const HeldPiece piece_;
  bool apart_ = false;
};

}  // namespace

std::string detachFault(const TaskConfig& task) {
  return groupFault(task.detach.given, "detach");
}

std::unique_ptr<TaskJudge> detachJudge(const TaskConfig& task, const Session& session) {
  try {
    return std::make_unique<DetachJudge>(task.detach, session.model());
  } catch (const TaskError& error) {
    throw TaskError(task.name + ": " + error.what());
  }
}

TaskShapes detachShapes(const TaskConfig& task) {
  return {{circleOf(task.detach.position_m, Vector3d::UnitZ(), kDetachMark_m)}, Vector3d::UnitZ()};
}

}  // namespace viscera
