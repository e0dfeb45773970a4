// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "bench/harness/specimens/specimen.h"
#include "viscera/session/session.h"

namespace viscera::bench {

/// Outputs to which a viewer of a session subscribes.
enum class Wanted { kNothing, kSurface, kImages, kSurfaceAndImages, kEveryImage };
std::string nameOf(Wanted wanted);
/// Returns the outputs of the next step: images at the rates of the cameras, or after every tick (kEveryImage).
FrameRequest outputsOf(const Session& session, Wanted wanted);

/// A probe that works on a body. It waits until the tissue has sagged, approaches from the patient's left and presses
/// into it. Then it moves in and out once per second of simulated time.
class Pressing {
 public:
  /// Steps the session until the probe is inside.
  explicit Pressing(Session& session);
  /// Returns the pose for the session's next tick, received now.
  StylusSamples now() const;

 private:
  const Session& session_;
  uint64_t start_tick_;
  Vector3d touching_m_;  ///< position of the tip when contact begins [m]
};

struct SessionSpeed {
  int ticks = 0;
  double tick_s = 0;  ///< mean time of a tick with the requested outputs [s]
  ViewCounters work;  ///< work in these ticks
};

/// Steps a session as fast as possible, then waits for outputs in flight. Three ticks warm up.
/// @param samples  returns the samples of the next tick
SessionSpeed measureSession(Session& session, Wanted wanted, double seconds,
                            const std::function<StylusSamples()>& samples);

}  // namespace viscera::bench
