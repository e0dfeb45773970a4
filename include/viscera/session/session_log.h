// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "viscera/api.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/knot_kind.h"
#include "viscera/model/scene/overlays.h"
#include "viscera/tools/force_limiter.h"
#include "viscera/tools/stylus.h"

namespace VISCERA_PUBLIC viscera {

class Session;

/// Observer of all changes to a session, called after each change on the session's thread. The same changes, applied to
/// another session of the same scene from the same state on, lead to the same states.
class VISCERA_PUBLIC SessionLog {
 public:
  virtual ~SessionLog() = default;
  virtual void stepped(Session&, const StylusSamples&) {}
  /// Receives the measurements of a tick: once for each, in order, some steps late. Its number counts from the start or
  /// the last reset.
  virtual void measured(const Session&, uint64_t /*tick*/, const layout::TickStats&) {}
  virtual void wasReset() {}
  virtual void inputCleared() {}
  virtual void restored(Session&) {}  ///< after wasReset(): the session is in another state
  virtual void toolModeSet(size_t /*stylus*/, ToolSwitch, ToolMode) {}
  virtual void forceLimitsSet(size_t /*stylus*/, const ForceLimits&) {}
  virtual void obstacleFrameSet(size_t /*obstacle*/, const Pose&) {}
  virtual void cameraFrameSet(size_t /*camera*/, const Pose&) {}
  virtual void sutureTied(size_t /*piece*/, const SutureTie&) {}
  virtual void taskRecorded(Session&, const std::string& /*name*/, const std::string& /*yaml*/) {}
  virtual void overlaysSet(size_t /*camera*/, const Overlays&) {}
};

}  // namespace viscera
