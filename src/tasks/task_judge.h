// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tasks/task_marks.h"
#include "tasks/task_measures.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/math/types.h"
#include "viscera/solver/clip_state.h"
#include "viscera/solver/fibre_state.h"
#include "viscera/solver/state.h"
#include "viscera/solver/suture_state.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// Results of a tick by which a task is judged.
struct TaskTick {
  ToolMotions motions{};
  std::vector<Vector3d> cuts_m;  ///< positions of springs cut in the tick, in the rest shape
  /// TaskJudge::piecesApart() after the tick, where something was cut in it.
  uint32_t apart = 0;
  size_t spared_cuts = 0;            ///< springs cut in TaskConfig::spared_parts
  std::vector<SutureState> sutures;  ///< where the task needs them
  ClipStates clips;                  ///< where the task needs them
  std::vector<FibreState> fibres;    ///< of attachments, where the task needs them
  double blood_ml = 0, bile_ml = 0;  ///< lost since the last reset
  std::optional<double> gap_m;       ///< TaskJudge::gapOf() after the tick, where requested
  layout::TickStats stats{};
  double tick_s = 0;
};

/// Returns the distance that the tip of a tool that cuts or burns moved in a tick, across a direction [m]; the larger
/// one of two.
double bladeTravel(const TaskTick& tick, const Vector3d& normal);
/// Returns why a vector cannot be a direction, or empty. @param key  of it
std::string directionFault(const Vector3d& direction, const char* key);
/// Returns why a kind's group of keys is needed, or empty. @param name  of it
std::string groupFault(bool given, const char* name);
/// Returns the corners of a circle, the first one twice. @param normal  of any length
std::vector<Vector3d> circleOf(const Vector3d& center_m, const Vector3d& normal, double radius_m);

/// Lines to draw, and the normal of their plane. The work is in that plane, or along the normal.
struct TaskShapes {
  std::vector<std::vector<Vector3d>> lines_m;  ///< in the rest shape
  Vector3d normal = Vector3d::UnitZ();
  bool along_normal = false;  ///< whether plots show the normal as one of their axes
};

/// Judge of a task's ticks, in order, that reports progress towards the goal. It does not depend on wall-clock time.
class TaskJudge {
 public:
  virtual ~TaskJudge() = default;
  virtual void judge(const TaskTick& tick, TaskTally& tally) = 0;
  /// Returns whether it needs the positions of cut springs. Then ticks that may have cut are waited for.
  virtual bool usesCuts() const { return false; }
  /// Returns whether the piece to be cut off is separate: 1 or 0, for an operation one bit per stage. Called on the
  /// session's thread. @param fibres  of attachments
  virtual uint32_t piecesApart(const CutState&, const std::vector<FibreState>& /*fibres*/) const { return 0; }
  /// Returns whether it has to see ticks before and after its own stage of an operation.
  virtual bool judgesAlways() const { return false; }
  /// Returns whether a clip at this position at rest [m] is one of its own.
  virtual bool claims(const Vector3d&) const { return false; }
  /// Returns whether it needs knots.
  virtual bool usesSutures() const { return false; }
  /// Returns whether it needs clips.
  virtual bool usesClips() const { return false; }
  /// Returns whether it needs the fibres of attachments.
  virtual bool usesFibres() const { return false; }
  /// Returns whether it needs the gap of a wound. Then the tissue is waited for.
  virtual bool asksForGap(const std::vector<SutureState>&) const { return false; }
  /// Returns how much farther apart the sides of a wound are than at rest [m]; called on the session's thread.
  virtual double gapOf(const HostState&) const { return 0; }
  virtual double progress() const = 0;  ///< 0..1
  virtual bool reached() const = 0;
  virtual std::string step() const = 0;                   ///< what the trainee has to do now
  virtual std::vector<MarkConfig> marks() const = 0;      ///< marks on the tissue, always the same
  virtual std::vector<MarkState> markStates() const = 0;  ///< [marks] now
};

}  // namespace viscera
