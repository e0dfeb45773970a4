// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "math/archive.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// Checks a mode that was read from a saved state. @throws Error  there is no such mode
void requireMode(const Archive& archive, ToolMode mode);
/// Checks the modes of motions that were read from a saved state.
void requireModes(const Archive& archive, const ToolMotions& motions);

}  // namespace viscera
