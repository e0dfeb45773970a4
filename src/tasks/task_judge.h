// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tasks/task_measures.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/math/types.h"
#include "viscera/solver/seen_clip.h"
#include "viscera/solver/seen_thread.h"
#include "viscera/solver/state.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// What a tick brought, as a task is judged by it.
struct TaskTick {
  ToolMotions motions{};
  std::vector<Vector3d> cuts_m;     ///< where springs were cut in it: of the tissue at rest
  bool apart = false;               ///< TaskJudge::isApart() after it, where something was cut in it
  std::vector<SeenThread> threads;  ///< where the task heeds them
  SeenClips clips;                  ///< where the task heeds them
  double blood_ml = 0;              ///< that has run out since the last reset
  std::optional<double> gap_m;      ///< TaskJudge::gapOf() after it, where that was asked for
  layout::TickStats stats{};
  double tick_s = 0;
};

/// How far the tip of a tool that cuts or burns went in a tick, across a direction [m]; of two that of the one that
/// went farther.
double bladeTravel(const TaskTick& tick, const Vector3d& normal);
/// Why it cannot be a direction, or empty. @param key  of it
std::string directionFault(const Vector3d& direction, const char* key);
/// What a kind's group of keys must be there for. @param name  of it
std::string groupFault(bool given, const char* name);
/// Corners of a circle, the first one twice. @param normal  of any length
std::vector<Vector3d> circleOf(const Vector3d& center_m, const Vector3d& normal, double radius_m);

/// Lines to draw, and the plane in which they lie.
struct TaskShapes {
  std::vector<std::vector<Vector3d>> lines_m;  ///< at rest
  Vector3d normal = Vector3d::UnitZ();
};

/// Looks at a task's ticks in order and says how far its goal is. It knows nothing of the clock.
class TaskJudge {
 public:
  virtual ~TaskJudge() = default;
  virtual void judge(const TaskTick& tick, TaskTally& tally) = 0;
  /// Does it ask where springs were cut? Then the tissue is waited for after ticks that may have cut.
  virtual bool heedsCuts() const { return false; }
  /// Whether what was to be cut off is; asked on the session's thread.
  virtual bool isApart(const CutState&) const { return false; }
  /// Does it ask for knots?
  virtual bool heedsThreads() const { return false; }
  /// Does it ask for clips?
  virtual bool heedsClips() const { return false; }
  /// Is it to be known how far a wound gapes? Then the tissue is waited for.
  virtual bool asksForGap(const std::vector<SeenThread>&) const { return false; }
  /// How much farther apart the sides of a wound are than at rest [m]; asked on the session's thread.
  virtual double gapOf(const HostState&) const { return 0; }
  virtual double progress() const = 0;  ///< 0..1
  virtual bool reached() const = 0;
  virtual std::string step() const = 0;  ///< what is to be done now
};

}  // namespace viscera
