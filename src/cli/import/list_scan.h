// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "cli/commands.h"
#include "viscera/math/types.h"

namespace viscera::cli {

/// Returns "x, y, z", six digits each.
std::string listText(const Vector3d& v, double scale = 1);

/// Prints the contents of a scan: format, series, size, spacing, position, values and labels.
/// @returns exit status of the command
int listScan(const ImportOptions& options);

}  // namespace viscera::cli
