// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "bench/harness/specimens/specimen.h"
#include "viscera/session/session.h"

namespace viscera::bench {

/// What a viewer of a session subscribes to.
enum class Wanted { kNothing, kSurface, kImages, kSurfaceAndImages, kEveryImage };
std::string nameOf(Wanted wanted);
/// The wants of the coming step: images at the rates of the cameras, or after every tick (kEveryImage).
Wants wantsOf(const Session& session, Wanted wanted);

/// A probe that works on a body. It waits until the tissue has sagged, comes from the patient's left and presses into
/// it; then it goes in and out once a second of simulated time.
class Pressing {
 public:
  /// Steps the session until the probe is in.
  explicit Pressing(Session& session);
  /// The pose of the session's next tick, received now.
  StylusSamples now() const;

 private:
  const Session& session_;
  uint64_t start_tick_;
  Vector3d touching_m_;  ///< where the tip is when the probe just touches
};

struct SessionSpeed {
  int ticks = 0;
  double tick_s = 0;  ///< mean, what is asked for included
  ViewCounters work;  ///< done in these ticks
};

/// Steps a session as fast as it goes, then waits for what is under way. Three ticks warm up.
/// @param samples  of the next tick
SessionSpeed measureSession(Session& session, Wanted wanted, double seconds,
                            const std::function<StylusSamples()>& samples);

}  // namespace viscera::bench
