// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <optional>

#include "model/scene/tool_kinds.h"
#include "tasks/task_kinds.h"
#include "viscera/session/session.h"

namespace viscera {

namespace {

/// A contact that is interrupted for less counts as one: a tip that trembles on the tissue touches it once.
constexpr double kContactGap_s = 0.1;
/// Share of the height to reach: tissue that was never this high was not dropped.
constexpr double kLiftedShare = 0.25;

using Styluses = std::vector<StylusConfig>;

/// Returns the distance from the reach of a tip to a position [m]; below 0 inside.
double gapTo(const Vector3d& position_m, const StylusMotion& motion, const StylusConfig& stylus) {
  return (motion.to.position_m - position_m).norm() - kindOf(motion.mode).reach_m(stylus);
}

class TouchJudge : public TaskJudge {
 public:
  TouchJudge(const TouchGoal& goal, Styluses styluses)
      : goal_(goal), styluses_(std::move(styluses)), wrong_(goal.targets.size()) {}

  void judge(const TaskTick& tick, TaskTally& tally) override {
    for (size_t s = 0; s < styluses_.size(); ++s) {
      Contact& contact = contacts_[s];
      const bool touches = tick.motions[s].present && tick.stats.touched[s] + tick.stats.grabbed[s] > 0;
      contact.gap_s = touches ? 0 : contact.gap_s + tick.tick_s;
      if (contact.gap_s > kContactGap_s) contact.at.reset();
      if (!touches) continue;
      const size_t here = targetAt(tick.motions[s], styluses_[s]);
      // Sliding from a target onto the tissue next to it is not a new touch.
      if (contact.at && (here == *contact.at || here == kNowhere)) continue;
      contact.at = here;
      if (here == due_) {
        wrong_[due_++] = false;
      } else {
        ++tally.wrong_touches;
        if (here != kNowhere && here > due_) wrong_[here] = true;
      }
    }
  }
  double progress() const override { return static_cast<double>(due_) / static_cast<double>(goal_.targets.size()); }
  bool reached() const override { return due_ == goal_.targets.size(); }
  std::string step() const override {
    return "touch target " + std::to_string(std::min(due_ + 1, goal_.targets.size())) + " of " +
           std::to_string(goal_.targets.size());
  }
  std::vector<MarkConfig> marks() const override {
    std::vector<MarkConfig> out;
    for (const TaskPosition& target : goal_.targets)
      out.push_back(targetMark(target.position_m, Vector3d::Zero(), goal_.radius_m));
    return out;
  }
  /// Returns wrong for a target that was touched when it was another's turn, until its own.
  std::vector<MarkState> markStates() const override {
    std::vector<MarkState> out;
    for (size_t i = 0; i < wrong_.size(); ++i) {
      out.push_back(wrong_[i]   ? MarkState::kWrong
                    : i < due_  ? MarkState::kDone
                    : i == due_ ? MarkState::kNext
                                : MarkState::kLater);
    }
    return out;
  }

 private:
  static constexpr size_t kNowhere = SIZE_MAX;
  struct Contact {
    std::optional<size_t> at;  ///< index of the touched target, or kNowhere
    double gap_s = 0;
  };
  size_t targetAt(const StylusMotion& motion, const StylusConfig& stylus) const {
    size_t out = kNowhere;
    double least_m = goal_.radius_m;
    for (size_t i = 0; i < goal_.targets.size(); ++i) {
      const double gap_m = gapTo(goal_.targets[i].position_m, motion, stylus);
      if (gap_m > least_m) continue;
      least_m = gap_m;
      out = i;
    }
    return out;
  }

  const TouchGoal goal_;
  const Styluses styluses_;
  std::array<Contact, layout::kMaxStyluses> contacts_{};
  size_t due_ = 0;
  std::vector<bool> wrong_;  ///< [targets]
};

class LiftJudge : public TaskJudge {
 public:
  LiftJudge(const LiftGoal& goal, Styluses styluses)
      : goal_(goal), up_(goal.up.normalized()), styluses_(std::move(styluses)) {}

  void judge(const TaskTick& tick, TaskTally& tally) override {
    height_m_ = 0;
    for (size_t s = 0; s < styluses_.size(); ++s) {
      const StylusMotion& motion = tick.motions[s];
      Hold& hold = holds_[s];
      const bool holds = motion.present && tick.stats.grabbed[s] > 0;
      if (!holds) {
        tally.drops += hold.held && hold.highest_m > kLiftedShare * goal_.height_m && !reached();
        hold = {};
        continue;
      }
      if (!hold.held) {
        hold = {true, gapTo(goal_.center_m, motion, styluses_[s]) <= goal_.radius_m, motion.to.position_m, 0};
      }
      const double height_m = up_.dot(motion.to.position_m - hold.from_m);
      hold.highest_m = std::max(hold.highest_m, height_m);
      if (hold.counts) height_m_ = std::max(height_m_, height_m);
    }
    held_ = height_m_ > 0;
    high_s_ = reached() ? high_s_ : height_m_ >= goal_.height_m ? high_s_ + tick.tick_s : 0;
    done_ = done_ || high_s_ >= goal_.hold_s;
  }
  double progress() const override {
    const double height = std::min(1.0, height_m_ / goal_.height_m);
    const double time = goal_.hold_s > 0 ? std::min(1.0, high_s_ / goal_.hold_s) : height;
    return done_ ? 1 : (height + time) / 2;
  }
  bool reached() const override { return done_; }
  std::string step() const override {
    return !held_ ? "take hold of the tissue at the mark" : high_s_ > 0 ? "keep it there" : "lift it";
  }
  std::vector<MarkConfig> marks() const override { return {targetMark(goal_.center_m, up_, goal_.radius_m)}; }
  /// Returns wrong while tissue is held elsewhere.
  std::vector<MarkState> markStates() const override {
    const bool elsewhere =
        std::any_of(holds_.begin(), holds_.end(), [](const Hold& hold) { return hold.held && !hold.counts; });
    return {done_ ? MarkState::kDone : elsewhere ? MarkState::kWrong : MarkState::kNext};
  }

 private:
  struct Hold {
    bool held = false, counts = false;
    Vector3d from_m = Vector3d::Zero();
    double highest_m = 0;
  };
  const LiftGoal goal_;
  const Vector3d up_;
  const Styluses styluses_;
  std::array<Hold, layout::kMaxStyluses> holds_{};
  double height_m_ = 0, high_s_ = 0;
  bool held_ = false, done_ = false;
};

}  // namespace

std::string touchFault(const TaskConfig& task) {
  if (!task.touch.given) return groupFault(false, "touch_targets");
  return task.touch.targets.empty() ? "'touch_targets.targets' must be a list of one or more positions; found none"
                                    : "";
}

std::unique_ptr<TaskJudge> touchJudge(const TaskConfig& task, const Session& session) {
  return std::make_unique<TouchJudge>(task.touch, session.scene().styluses);
}

TaskShapes touchShapes(const TaskConfig& task) {
  TaskShapes out;
  for (const TaskPosition& target : task.touch.targets)
    out.lines_m.push_back(circleOf(target.position_m, Vector3d::UnitZ(), task.touch.radius_m));
  return out;
}

std::string liftFault(const TaskConfig& task) {
  return task.lift.given ? directionFault(task.lift.up, "lift.up") : groupFault(false, "lift");
}

std::unique_ptr<TaskJudge> liftJudge(const TaskConfig& task, const Session& session) {
  return std::make_unique<LiftJudge>(task.lift, session.scene().styluses);
}

TaskShapes liftShapes(const TaskConfig& task) {
  return {{circleOf(task.lift.center_m, task.lift.up, task.lift.radius_m)}, task.lift.up, true};
}

}  // namespace viscera
