// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "cli/commands.h"
#include "viscera/math/types.h"

namespace viscera::cli {

/// Returns "x, y, z", six digits each.
std::string listText(const Vector3d& v, double scale = 1);

/// Prints what a scan holds: format, series, size, spacing, place, values and labels. @returns status of the command
/// @throws SceneError  as openScan()
int listScan(const ImportOptions& options);

}  // namespace viscera::cli
