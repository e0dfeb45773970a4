// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "viscera/api.h"
#include "viscera/calibration/step_time.h"

namespace VISCERA_PUBLIC viscera {

struct Scene;

/// Returns the scene with a number in place of every `spacing_m: auto`. All these bodies get one spacing, the finest
/// that this machine steps solver.real_time_factor times as fast as the clock. The first of them gets a note with the
/// choice and its reason. Other scenes are returned as they are, and nothing is measured.
/// @param context  current on this thread, or null: there is none
/// @param known  speed of this machine; none: it is measured here
/// @throws MeshError, LatticeError, SceneError  as buildModel()
Scene withChosenSpacing(const Scene& scene, const gpu::Context* context, const Progress& progress = {},
                        const std::optional<StepTime>& known = {});

/// Returns the share of the clock that steps may take; surface, images and viewers have the rest. On a software
/// rasteriser that leaves time for 10 images a second of every camera, and for a viewer on the same processors.
/// @param software  OpenGL is   @param processors  of the machine
double shareOfSteps(const Scene& scene, bool software, unsigned processors);

}  // namespace viscera
