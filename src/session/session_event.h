// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "math/archive.h"
#include "viscera/session/session.h"

namespace viscera {

/// Event or measurement of a session in a recording.
struct SessionEvent {
  enum class Kind : uint8_t {
    kStep,
    kMeasured,
    kReset,
    kClearInput,
    kToolMode,
    kForceLimits,
    kObstacleFrame,
    kCameraFrame,
    kOverlays,
    kTask,
    kTie,
  };
  Kind kind = Kind::kStep;
  StylusSamples samples{};              ///< for a step
  uint64_t tick = 0;                    ///< tick of a measurement
  uint32_t measured = 0;                ///< fingerprint of the measurement
  uint32_t index = 0;                   ///< index of the stylus, obstacle, camera or piece of a suture
  ToolSwitch when = ToolSwitch::kIdle;  ///< for a tool mode
  ToolMode mode = ToolMode::kNone;      ///< for a tool mode
  ForceLimits limits{0, 0};             ///< for force limits
  Pose pose;                            ///< for a frame
  Overlays overlays;                    ///< for overlays
  std::string task, task_yaml;          ///< for a task
  SutureTie tie;                        ///< for a piece of a suture

  /// Reads or writes the event. @param styluses  number in the scene
  void persist(Archive& archive, size_t styluses);
  /// Applies the event to a session, except steps and measurements. It skips what a scene with other cameras does not
  /// have.
  void apply(Session& session) const;
  /// Checks the event against a scene. @throws Error  no session of this scene can have had it
  void require(const Scene& scene) const;
};

/// Returns a fingerprint of the exact part of measurements, for any backend: two sessions in the same state have the
/// same.
uint32_t fingerprintOf(const layout::TickStats& stats);

}  // namespace viscera
