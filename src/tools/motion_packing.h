// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/layout/tool_motion.h"
#include "viscera/tools/stylus.h"

namespace viscera {

struct StylusConfig;

/// Returns the effects of a stylus on tissue in a tick, bits of ToolEffect: scissors that do not close cut nothing.
uint32_t effectsOf(const StylusMotion& motion);

/// Returns the rotation of a shaft that tissue meets over a tick, as a vector along its axis of rotation [rad]; zero of
/// other shafts.
Vector3d turnOfShaft(const StylusMotion& motion);

/// Returns ToolMotion.info of a mode: its number, and its effects on tissue (ToolEffect).
layout::uvec4 toolInfo(ToolMode mode);

/// Divides motions into substeps for the solver: [substeps * kMaxStyluses], substep-major (physics.md 2: tool poses are
/// interpolated over the substeps of a tick).
void interpolateMotions(const ToolMotions& motions, const std::vector<StylusConfig>& configs, int substeps,
                        std::vector<layout::ToolMotion>& out);

}  // namespace viscera
