// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "cli/commands.h"
#include "tasks/hand_log.h"
#include "viscera/gpu/context.h"
#include "viscera/model/scene/scene.h"
#include "viscera/tools/strokes.h"

namespace viscera::cli {

/// What a run is made of, read and checked.
struct RunPlan {
  Scene scene;
  Strokes strokes;
  uint64_t ticks;
};
/// @throws Error, SceneError, StrokesError
RunPlan planRun(const RunOptions& options);

/// The context of a session, or none. @throws GpuError  with a way out
std::unique_ptr<gpu::Context> contextFor(bool no_view, const Scene& scene);

/// hands.csv and kinematics.txt. @throws Error  one cannot be written
void writeHands(const HandRows& hands, const std::string& folder);

}  // namespace viscera::cli
