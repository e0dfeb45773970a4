// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "model/scene/tool_kinds.h"
#include "render/shapes/tool_shape.h"

namespace viscera {

/// Adds one of two jaws, that towards +x, along the axis as when closed, from the pivot to its tip at z = 0: toothed
/// for tools that hold, a blade for scissors, a broad one for clips. @param unit_m  half of its thickness at the middle
void addJaw(const ToolKind& kind, float length_m, float unit_m, const std::array<uint8_t, 4>& color, ToolShape& shape);

/// Adds the fork and the pin that hold the jaws at their pivot.
void addFork(float pivot_m, float unit_m, const std::array<uint8_t, 4>& color, ToolShape& shape);

}  // namespace viscera
