// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/api.h"
#include "viscera/model/body/spacing_choice.h"

namespace VISCERA_PUBLIC viscera {

struct Scene;

namespace gpu {
class Context;
}

/// Measured time of a substep of a lattice with this number of nodes.
struct TimedSubstep {
  double nodes = 0, seconds = 0;
};

/// Returns the straight line through two measurements. Where it makes no sense, as with caches that overflow or other
/// load on the machine, returns a time in proportion to the nodes, through the larger one.
StepTime stepTimeThrough(const TimedSubstep& small, const TimedSubstep& large);

/// Measures how fast this machine steps the bodies of a scene with spacing `auto`, with the scene's backend,
/// integrator, tools and stability monitor. Takes some tenths of a second, on coarse lattices of these bodies.
/// @param context  current on this thread, or null: there is none, and the CPU is measured
StepTime measureStepTime(const UndividedBodies& bodies, const Scene& scene, const gpu::Context* context);

}  // namespace viscera
