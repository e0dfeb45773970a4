// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "cli/commands.h"
#include "viscera/model/fitted_scene.h"
#include "viscera/model/shape/solid.h"

namespace viscera::cli {

/// Returns the path of a scene: a file, or a shipped scene of that name. @throws SceneError  names the searched places
std::string findScene(const std::string& name);
/// Returns the path of a task likewise. @throws Error
std::string findTask(const std::string& name);
/// Loads the scene of the options, fitted to the mesh if they name one. @throws SceneError
FittedScene sceneOf(const RunOptions& options);
/// Returns a callback that reports preparation on standard error: one line per stage, refreshed on a terminal.
Progress consoleProgress();

}  // namespace viscera::cli
