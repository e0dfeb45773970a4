// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/body/spacing_choice.h"

namespace viscera {

struct Scene;

namespace gpu {
class Context;
}

/// What a substep took of a lattice of so many nodes.
struct TimedSubstep {
  double nodes = 0, seconds = 0;
};

/// The straight line through two measurements. Where it makes no sense, as with caches that overflow or a machine that
/// did something else meanwhile: in proportion to the nodes, as long as the larger one took.
StepTime stepTimeThrough(const TimedSubstep& small, const TimedSubstep& large);

/// How fast this machine steps the bodies of a scene whose spacing is `auto`, with the scene's backend, integrator,
/// tools and governor, measured on coarse lattices of theirs in some tenths of a second.
/// @param context  current on this thread, or null: there is none, and the CPU is measured
StepTime measureStepTime(const UndividedBodies& bodies, const Scene& scene, const gpu::Context* context);

}  // namespace viscera
