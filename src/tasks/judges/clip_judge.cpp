// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include "model/scene/tool_kinds.h"
#include "tasks/cut_watch.h"
#include "tasks/task_kinds.h"
#include "viscera/session/session.h"

namespace viscera {

namespace {

constexpr double kMm = 1000;

class ClipJudge : public TaskJudge {
 public:
  ClipJudge(const ClipGoal& goal, const Model& model)
      : goal_(goal),
        at_(goal.clips.size(), false),
        joint_(model, goal.clips.front().position_m, goal.clips.back().position_m, goal.part) {}
  bool usesCuts() const override { return true; }
  bool usesClips() const override { return true; }
  bool judgesAlways() const override { return true; }
  bool claims(const Vector3d& clip_m) const override { return nearest(clip_m).second <= goal_.radius_m; }
  uint32_t piecesApart(const CutState& cuts, const std::vector<FibreState>&) const override {
    return joint_.isApart(cuts) ? 1 : 0;
  }
  void judge(const TaskTick& tick, TaskTally& tally) override {
    std::fill(at_.begin(), at_.end(), false);
    size_t bad = tick.clips.empty + tick.clips.taken_off;
    tally.clip_off_mm = 0;
    for (const ClipState& clip : tick.clips.on) {
      const auto [position, off_m] = nearest(clip.rest_m);
      const bool good = off_m <= goal_.radius_m && !at_[position];
      bad += !good;
      if (!good) continue;
      at_[position] = true;
      tally.clip_off_mm = std::max(tally.clip_off_mm, kMm * off_m);
    }
    tally.bad_clips = static_cast<double>(bad);
    // Tissue divided without clips on both sides has bled; later clips do not make up for it.
    if (tick.apart != 0 && !apart_) clipped_first_ = allClipped();
    apart_ = apart_ || tick.apart != 0;
  }
  double progress() const override {
    const auto clipped = static_cast<double>(std::count(at_.begin(), at_.end(), true));
    return (clipped + (reached() ? 1 : 0)) / static_cast<double>(at_.size() + 1);
  }
  bool reached() const override { return apart_ && clipped_first_ && allClipped(); }
  std::string step() const override {
    if (apart_ && !clipped_first_) return "it was divided before it was clipped; start again";
    if (allClipped()) return "divide the tissue between the clips";
    return "set clips: " + std::to_string(std::count(at_.begin(), at_.end(), true)) + " of " +
           std::to_string(at_.size()) + " are in place";
  }
  /// Returns a ring at each clip, then one where the tissue is divided.
  std::vector<MarkConfig> marks() const override {
    const Vector3d offset_m = goal_.clips.back().position_m - goal_.clips.front().position_m;
    const double width_m = kRingWidth * goal_.radius_m;
    const double reach_m = (goal_.part.empty() ? kRingReach : kPartReach) * goal_.radius_m;
    const auto ring = [&](const Vector3d& at_m) {
      return offset_m.isZero() ? targetMark(at_m, offset_m, goal_.radius_m)
                               : ringMark(at_m, offset_m, reach_m, width_m);
    };
    std::vector<MarkConfig> out;
    for (const TaskPosition& clip : goal_.clips) out.push_back(ring(clip.position_m));
    const size_t before = goal_.before();
    out.push_back(ring((goal_.clips[before - 1].position_m + goal_.clips[before].position_m) / 2));
    return out;
  }
  std::vector<MarkState> markStates() const override {
    const bool wrong = apart_ && !clipped_first_;
    std::vector<MarkState> out;
    for (const bool at : at_) out.push_back(at ? MarkState::kDone : wrong ? MarkState::kWrong : MarkState::kNext);
    out.push_back(wrong          ? MarkState::kWrong
                  : apart_       ? MarkState::kDone
                  : allClipped() ? MarkState::kNext
                                 : MarkState::kLater);
    return out;
  }

 private:
  static constexpr double kRingWidth = 0.2;  ///< over the distance within which a clip counts
  static constexpr double kRingReach = 4;    ///< farthest surface of the tissue, over the same
  static constexpr double kPartReach = 0.8;  ///< the same of a part that is next to others
  bool allClipped() const {
    return std::all_of(at_.begin(), at_.end(), [](bool at) { return at; });
  }
  std::pair<size_t, double> nearest(const Vector3d& rest_m) const {
    std::pair<size_t, double> out{0, std::numeric_limits<double>::infinity()};
    for (size_t i = 0; i < goal_.clips.size(); ++i) {
      const double off_m = (rest_m - goal_.clips[i].position_m).norm();
      if (off_m < out.second) out = {i, off_m};
    }
    return out;
  }

  const ClipGoal goal_;
  std::vector<bool> at_;  ///< [clips of the goal] whether a clip is there
  const Joint joint_;
  bool apart_ = false, clipped_first_ = false;
};

}  // namespace

std::string clipFault(const TaskConfig& task) {
  if (!task.clip.given) return groupFault(false, "clip_and_divide");
  const size_t count = task.clip.clips.size();
  const int after = task.clip.divide_after;
  if (after > 0 && count < 2)
    return "'clip_and_divide.clips' must be a list of two positions or more; found " + std::to_string(count);
  if (after > 0)
    return task.clip.before() < count ? ""
                                      : "'clip_and_divide.divide_after' must be 0 .. " + std::to_string(count - 1) +
                                            ", fewer than the clips; found " + std::to_string(after);
  return count >= 2 && count % 2 == 0 ? ""
                                      : "'clip_and_divide.clips' must be a list of an even number of positions, or "
                                        "'divide_after' above 0; found " +
                                            std::to_string(count);
}

std::unique_ptr<TaskJudge> clipJudge(const TaskConfig& task, const Session& session) {
  if (!mayClip(session.scene().styluses))
    throw TaskError(task.name + ": 'kind' clip_and_divide needs a scene with a stylus that has mode clip, but " +
                    session.scene().name + " has none");
  try {
    return std::make_unique<ClipJudge>(task.clip, session.model());
  } catch (const TaskError& error) {
    throw TaskError(task.name + ": " + error.what());
  }
}

/// Returns a small circle at each position, about the line from the first to the last.
TaskShapes clipShapes(const TaskConfig& task) {
  const Vector3d first_m = task.clip.clips.front().position_m;
  const Vector3d offset = task.clip.clips.back().position_m - first_m;
  TaskShapes out;
  out.along_normal = true;
  out.normal = offset.norm() > 0 ? Vector3d(offset.normalized()) : Vector3d(Vector3d::UnitX());
  for (const TaskPosition& position : task.clip.clips)
    out.lines_m.push_back(circleOf(position.position_m, out.normal, task.clip.radius_m));
  return out;
}

}  // namespace viscera
