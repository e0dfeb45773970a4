// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "render/shapes/tool_shape.h"
#include "viscera/model/scene/environment_config.h"

namespace viscera {

/// Edge of the square around its origin as which a plane is drawn.
constexpr double kDrawnPlane_m = 1;

/// Returns the drawn shape of an obstacle in its own frame, in the true size of the volume that nodes do not enter.
ToolShape obstacleShape(const ObstacleConfig& obstacle);

}  // namespace viscera
