// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "viscera/layout/limits.h"
#include "viscera/model/model.h"
#include "viscera/render/arrow.h"
#include "viscera/tools/force_limiter.h"
#include "viscera/tools/stylus.h"

namespace viscera {

constexpr double kArrowPerNewton_m = 0.1;  ///< length of an arrow, as in scene_markers by default
constexpr double kArrowOfWind_s = 0.01;    ///< an arrow of the wind is the path of the air in this time

/// Adds the force on each stylus, at its tip.
void addForceArrows(const ToolMotions& motions, const std::array<Reaction, layout::kMaxStyluses>& reactions,
                    std::vector<Arrow>& out);
/// Adds a square of arrows that end where the air reaches the bodies at rest. @param wind_m_per_s  no arrows if it is
/// zero
void addWindArrows(const Vector3d& wind_m_per_s, const Model& model, std::vector<Arrow>& out);

}  // namespace viscera
