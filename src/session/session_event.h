// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "math/archive.h"
#include "viscera/session/session.h"

namespace viscera {

/// Something that happened to a session, or was measured of it, as a recording holds it.
struct SessionEvent {
  enum class Kind : uint8_t {
    kStep,
    kMeasured,
    kReset,
    kForget,
    kToolMode,
    kForceLimits,
    kObstacleFrame,
    kCameraFrame,
    kOverlays,
    kTask,
    kTie,
  };
  Kind kind = Kind::kStep;
  StylusSamples samples{};              ///< of a step
  uint64_t tick = 0;                    ///< of what was measured
  uint32_t measured = 0;                ///< its fingerprint
  uint32_t index = 0;                   ///< of the stylus, obstacle, camera or piece of a thread
  ToolSwitch when = ToolSwitch::kIdle;  ///< of a tool mode
  ToolMode mode = ToolMode::kNone;      ///< of a tool mode
  ForceLimits limits{0, 0};             ///< of force limits
  Pose pose;                            ///< of a frame
  Overlays overlays;                    ///< of overlays
  std::string task, task_yaml;          ///< of a task
  ThreadTie tie;                        ///< of a piece of a thread

  /// @param styluses  of the scene
  void persist(Archive& archive, size_t styluses);
  /// Does it again, but for steps and measurements. What a scene with other cameras does not have is left out.
  void apply(Session& session) const;
  /// @throws Error  no session of this scene was told that
  void require(const Scene& scene) const;
};

/// Of what is exact in measurements, whatever measured: two sessions that are in the same state have the same.
uint32_t fingerprintOf(const layout::TickStats& stats);

}  // namespace viscera
