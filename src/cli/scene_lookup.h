// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "cli/commands.h"
#include "viscera/model/fitted_scene.h"
#include "viscera/model/shape/solid.h"

namespace viscera::cli {

/// The file itself, or the shipped scene of that name. @throws SceneError naming where it was looked for
std::string findScene(const std::string& name);
/// The same of a task. @throws Error
std::string findTask(const std::string& name);
/// The scene that options choose, fitted to the mesh where they name one. @throws SceneError
FittedScene sceneOf(const RunOptions& options);
/// Reports preparation on standard error: one line per stage, refreshed where it is a terminal.
Progress consoleProgress();

}  // namespace viscera::cli
