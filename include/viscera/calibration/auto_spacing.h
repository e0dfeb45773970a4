// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "viscera/calibration/step_time.h"

namespace viscera {

struct Scene;

/// The scene with a number in place of every `spacing_m: auto`: one spacing for all of these bodies, the finest that
/// this machine steps solver.real_time_factor times as fast as the clock. A line that tells the choice and its reason
/// becomes a note of the first of them. Other scenes come back as they are, and nothing is measured.
/// @param context  current on this thread, or null: there is none
/// @param known  how fast this machine is; none: it is measured here
/// @throws MeshError, LatticeError, SceneError  as buildModel()
Scene withChosenSpacing(const Scene& scene, const gpu::Context* context, const Progress& progress = {},
                        const std::optional<StepTime>& known = {});

/// Share of the clock that steps may take; surface, pictures and who looks at them have the rest. On a software
/// rasteriser that leaves time for 10 pictures a second of every camera, and for a viewer on the same processors.
/// @param software  OpenGL is   @param processors  of the machine
double shareOfSteps(const Scene& scene, bool software, unsigned processors);

}  // namespace viscera
