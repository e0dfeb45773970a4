// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "render/shapes/tool_shape.h"
#include "viscera/model/scene/environment_config.h"

namespace viscera {

/// A plane is drawn as a square of this edge around its origin.
constexpr double kDrawnPlane_m = 1;

/// What a person sees of an obstacle, in its own frame: what nodes do not enter, in its true size.
ToolShape obstacleShape(const ObstacleConfig& obstacle);

}  // namespace viscera
