// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "tasks/task_kinds.h"
#include "viscera/session/session.h"

namespace viscera {

namespace {

/// Judge of an operation: one judge per stage, in their order. Stages of clips and of tissue that is cut free are
/// judged in all ticks, as they depend on the order of events; others only while it is their turn.
class OperationJudge : public TaskJudge {
 public:
  OperationJudge(const TaskConfig& task, const Session& session) {
    for (const TaskStage& stage : task.operation.stages) {
      const TaskConfig own = stageOf(task, stage);
      stages_.push_back({stage.title, kindOf(own.kind).judge(own, session)});
    }
    const auto clips = [](const Stage& stage) { return stage.judge->usesClips(); };
    clip_stage_ = static_cast<size_t>(std::find_if(stages_.begin(), stages_.end(), clips) - stages_.begin());
  }
  bool usesCuts() const override {
    return any([](const TaskJudge& judge) { return judge.usesCuts(); });
  }
  bool usesSutures() const override {
    return any([](const TaskJudge& judge) { return judge.usesSutures(); });
  }
  bool usesClips() const override { return clip_stage_ < stages_.size(); }
  bool usesFibres() const override {
    return any([](const TaskJudge& judge) { return judge.usesFibres(); });
  }
  uint32_t piecesApart(const CutState& cuts, const std::vector<FibreState>& fibres) const override {
    uint32_t out = 0;
    for (size_t i = 0; i < stages_.size(); ++i) out |= (stages_[i].judge->piecesApart(cuts, fibres) & 1) << i;
    return out;
  }
  bool asksForGap(const std::vector<SutureState>& sutures) const override {
    return !reached() && stages_[due_].judge->asksForGap(sutures);
  }
  double gapOf(const HostState& state) const override { return reached() ? 0 : stages_[due_].judge->gapOf(state); }

  void judge(const TaskTick& tick, TaskTally& tally) override {
    for (size_t i = 0; i < stages_.size(); ++i) {
      Stage& stage = stages_[i];
      if (i == due_ || stage.judge->judgesAlways()) stage.judge->judge(seenBy(i, tick), stage.tally);
    }
    while (due_ < stages_.size() && stages_[due_].judge->reached()) ++due_;
    addTo(tally);
  }
  double progress() const override {
    const double within = reached() ? 0 : stages_[due_].judge->progress();
    return (static_cast<double>(due_) + within) / static_cast<double>(stages_.size());
  }
  bool reached() const override { return due_ == stages_.size(); }
  std::string step() const override {
    if (reached()) return "done";
    const Stage& stage = stages_[due_];
    return "stage " + std::to_string(due_ + 1) + " of " + std::to_string(stages_.size()) + ", " +
           (stage.title.empty() ? "" : stage.title + ": ") + stage.judge->step();
  }
  std::vector<MarkConfig> marks() const override {
    std::vector<MarkConfig> out;
    for (const Stage& stage : stages_) {
      const std::vector<MarkConfig> own = stage.judge->marks();
      out.insert(out.end(), own.begin(), own.end());
    }
    return out;
  }
  /// Returns the states; marks of stages to come are later, unless they are done or wrong already.
  std::vector<MarkState> markStates() const override {
    std::vector<MarkState> out;
    for (size_t i = 0; i < stages_.size(); ++i)
      for (const MarkState state : stages_[i].judge->markStates())
        out.push_back(i > due_ && state == MarkState::kNext ? MarkState::kLater : state);
    return out;
  }

 private:
  struct Stage {
    std::string title;
    std::unique_ptr<TaskJudge> judge;
    TaskTally tally = {};
  };
  template <class Test>
  bool any(const Test& test) const {
    return std::any_of(stages_.begin(), stages_.end(), [&](const Stage& stage) { return test(*stage.judge); });
  }

  /// Returns a tick with what concerns a stage. A clip at no position of any stage is one of the first stage of clips,
  /// as are those that closed on nothing.
  TaskTick seenBy(size_t stage, const TaskTick& tick) const {
    TaskTick out = tick;
    out.apart = (tick.apart >> stage) & 1;
    if (!stages_[stage].judge->usesClips()) return out;
    const auto is_others = [&](const ClipState& clip) {
      if (stages_[stage].judge->claims(clip.rest_m)) return false;
      const bool claimed = any([&](const TaskJudge& judge) { return judge.claims(clip.rest_m); });
      return claimed || stage != clip_stage_;
    };
    out.clips.on.erase(std::remove_if(out.clips.on.begin(), out.clips.on.end(), is_others), out.clips.on.end());
    if (stage != clip_stage_) out.clips.empty = out.clips.taken_off = 0;
    return out;
  }

  /// Adds up what the stages counted; of largest values the largest.
  void addTo(TaskTally& tally) const {
    constexpr double TaskTally::*kSums[] = {&TaskTally::off_path_mm, &TaskTally::wrong_touches, &TaskTally::drops,
                                            &TaskTally::weak_knots, &TaskTally::bad_clips};
    constexpr double TaskTally::*kLargest[] = {&TaskTally::deviation_mm, &TaskTally::gap_mm, &TaskTally::clip_off_mm};
    for (const auto value : kSums) {
      tally.*value = 0;
      for (const Stage& stage : stages_) tally.*value += stage.tally.*value;
    }
    for (const auto value : kLargest) {
      tally.*value = 0;
      for (const Stage& stage : stages_) tally.*value = std::max(tally.*value, stage.tally.*value);
    }
  }

  std::vector<Stage> stages_;
  size_t due_ = 0;         ///< stage that is to be reached next
  size_t clip_stage_ = 0;  ///< first stage of clips
};

}  // namespace

TaskConfig stageOf(const TaskConfig& task, const TaskStage& stage) {
  TaskConfig out;
  static_cast<TaskGoals&>(out) = stage;
  out.name = task.name;
  out.limits = task.limits;
  return out;
}

std::string operationFault(const TaskConfig& task) {
  if (!task.operation.given) return groupFault(false, "operation");
  const std::vector<TaskStage>& stages = task.operation.stages;
  if (stages.empty()) return "'operation.stages' must be a list of one stage or more; found none";
  for (size_t i = 0; i < stages.size(); ++i) {
    const std::string fault = kindOf(stages[i].kind).fault(stageOf(task, stages[i]));
    if (!fault.empty()) return "'operation.stages[" + std::to_string(i) + "]': " + fault;
  }
  return "";
}

std::unique_ptr<TaskJudge> operationJudge(const TaskConfig& task, const Session& session) {
  return std::make_unique<OperationJudge>(task, session);
}

/// Returns the shapes of all stages, seen as those of the first.
TaskShapes operationShapes(const TaskConfig& task) {
  TaskShapes out;
  for (const TaskStage& stage : task.operation.stages) {
    TaskShapes own = kindOf(stage.kind).shapes(stageOf(task, stage));
    if (out.lines_m.empty()) {
      out = std::move(own);
    } else {
      out.lines_m.insert(out.lines_m.end(), own.lines_m.begin(), own.lines_m.end());
    }
  }
  return out;
}

}  // namespace viscera
