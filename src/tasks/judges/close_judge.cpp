// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "math/number_text.h"
#include "model/body/body_nodes.h"
#include "tasks/cut_watch.h"
#include "tasks/task_kinds.h"
#include "viscera/session/session.h"

namespace viscera {

namespace {

constexpr double kMmPerM = 1000;

/// Two nodes on either side of a wound, as far from it as it is examined.
struct Facing {
  uint32_t left, right;  ///< slots of the model
  Vector3d across;       ///< unit vector from left to right
};

constexpr double kFar = 2;  // in spacings, from the searched position: a node farther away does not belong to the wound

/// Returns the node nearest to a position on one side of a plane. @param outward  from the plane to that side
/// @throws TaskError  there is no node nearby
uint32_t nodeBeside(const Model& model, const Vector3d& of_plane_m, const Vector3d& outward, const Vector3d& to_m) {
  uint32_t out = 0;
  double least_m2 = std::numeric_limits<double>::infinity();
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (const uint32_t slot : model.bodies[b].lattice.active_slots) {
      const Vector3d at_m = restPosition(model.bodies[b], slot);
      const double distance_m2 = (at_m - to_m).squaredNorm();
      if (outward.dot(at_m - of_plane_m) <= 0 || distance_m2 >= least_m2) continue;
      least_m2 = distance_m2;
      out = model.slotOffset(b) + slot;
    }
  }
  if (std::sqrt(least_m2) > kFar * longestSpacing(model))
    throw TaskError("'close_wound.path' has no tissue at 'reach_m' on either side of it, at rest");
  return out;
}

/// Returns one pair of nodes per spacing along the line.
std::vector<Facing> facingAlong(const CloseGoal& goal, const Model& model) {
  const double spacing_m = longestSpacing(model);
  std::vector<Facing> out;
  for (size_t i = 1; i < goal.line.path.size(); ++i) {
    const Vector3d from_m = goal.line.path[i - 1].position_m, offset_m = goal.line.path[i].position_m - from_m;
    const Vector3d across = offset_m.cross(goal.line.normal).normalized();
    if (across.norm() == 0) continue;  // a repeated position, or one straight above the last
    const auto pieces = static_cast<int>(std::max(1.0, std::floor(offset_m.norm() / spacing_m)));
    for (int k = 0; k < pieces; ++k) {
      const Vector3d at_m = from_m + (k + 0.5) / pieces * offset_m, beside_m = goal.reach_m * across;
      out.push_back({nodeBeside(model, at_m, -across, at_m - beside_m),
                     nodeBeside(model, at_m, across, at_m + beside_m), across});
    }
  }
  return out;
}

bool isWeak(KnotKind kind) {
  return kind != KnotKind::kSquare && kind != KnotKind::kSurgeons;
}

class CloseJudge : public TaskJudge {
 public:
  CloseJudge(const CloseGoal& goal, const Model& model)
      : goal_(goal), cut_(judgeOfLine(goal.line, longestSpacing(model))), facing_(facingAlong(goal, model)) {}
  bool usesCuts() const override { return true; }
  bool usesSutures() const override { return true; }
  bool asksForGap(const std::vector<SutureState>& sutures) const override {
    return tiedOf(sutures) >= static_cast<size_t>(goal_.knots);
  }
  double gapOf(const HostState& state) const override {
    double sum_m = 0;
    for (const Facing& pair : facing_) {
      const layout::vec4 &left = state.displacement_m[pair.left], &right = state.displacement_m[pair.right];
      sum_m += pair.across.dot(Vector3d(right.x - left.x, right.y - left.y, right.z - left.z));
    }
    return std::max(0.0, sum_m / static_cast<double>(facing_.size()));
  }
  void judge(const TaskTick& tick, TaskTally& tally) override {
    cut_->judge(tick, tally);
    tied_ = tiedOf(tick.sutures);
    holds_ = std::any_of(tick.stats.grabbed, tick.stats.grabbed + layout::kMaxStyluses, [](auto n) { return n > 0; });
    gap_m_ = tick.gap_m;
    tally.gap_mm = gap_m_ ? kMmPerM * *gap_m_ : 0;
    tally.weak_knots = 0;
    for (const SutureState& suture : tick.sutures) {
      for (const KnotState& knot : suture.knots) tally.weak_knots += knot.tied && isWeak(knot.kind);
    }
  }
  double progress() const override {
    const double knots = static_cast<double>(tied_) / goal_.knots;
    return (cut_->progress() + std::min(1.0, knots) + (reached() ? 1 : 0)) / 3;
  }
  bool reached() const override { return cut_->reached() && isClosed() && !holds_; }
  std::string step() const override {
    if (!cut_->reached()) return "open the tissue along the line";
    if (tied_ < static_cast<size_t>(goal_.knots))
      return "tie the sutures: " + std::to_string(tied_) + " of " + std::to_string(goal_.knots) + " knots, each with " +
             std::to_string(goal_.throws) + " throws";
    if (isClosed()) return "let go of the suture";
    return "the wound gapes by " + fixedText(kMmPerM * gap_m_.value_or(0), 1) +
           " mm: " + fixedText(kMmPerM * goal_.gap_m, 1) + " at most";
  }
  std::vector<MarkConfig> marks() const override { return cut_->marks(); }
  std::vector<MarkState> markStates() const override { return cut_->markStates(); }

 private:
  bool isClosed() const { return gap_m_ && *gap_m_ <= goal_.gap_m; }
  /// Counts tied knots. Knots that no tool threw count by their kind.
  size_t tiedOf(const std::vector<SutureState>& sutures) const {
    size_t out = 0;
    for (const SutureState& suture : sutures) {
      for (const KnotState& knot : suture.knots) {
        const auto throws = static_cast<int>(knot.turns.size());
        out += knot.tied && (throws == 0 || throws >= goal_.throws);
      }
    }
    return out;
  }

  const CloseGoal goal_;
  const std::unique_ptr<TaskJudge> cut_;
  const std::vector<Facing> facing_;
  size_t tied_ = 0;
  bool holds_ = false;
  std::optional<double> gap_m_;
};

}  // namespace

std::string closeFault(const TaskConfig& task) {
  return task.close.given ? faultOfLine(task.close.line, "close_wound") : groupFault(false, "close_wound");
}

std::unique_ptr<TaskJudge> closeJudge(const TaskConfig& task, const Session& session) {
  if (session.scene().sutures.empty())
    throw TaskError(task.name + ": 'kind' close_wound needs a scene with 'sutures', but " + session.scene().name +
                    " has none");
  try {
    return std::make_unique<CloseJudge>(task.close, session.model());
  } catch (const TaskError& error) {
    throw TaskError(task.name + ": " + error.what());
  }
}

TaskShapes closeShapes(const TaskConfig& task) {
  return shapesOfLine(task.close.line);
}

}  // namespace viscera
