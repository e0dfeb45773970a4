// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "cli/commands.h"
#include "tasks/tool_log.h"
#include "viscera/gpu/context.h"
#include "viscera/model/scene/scene.h"
#include "viscera/tools/strokes.h"

namespace viscera::cli {

/// The validated inputs of a run.
struct RunPlan {
  Scene scene;
  Strokes strokes;
  uint64_t ticks;
};
/// Reads the inputs of a run. @throws Error, SceneError, StrokesError
RunPlan planRun(const RunOptions& options);

/// Creates the context of a session, or none. @throws GpuError  with a suggestion
std::unique_ptr<gpu::Context> contextFor(bool no_view, const Scene& scene);

/// Writes tools.csv and kinematics.txt. @throws Error  one cannot be written
void writeTools(const ToolRows& tools, const std::string& folder);

}  // namespace viscera::cli
