// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/processes/suture/chain/chain.h"
#include "viscera/model/scene/suture_config.h"

namespace viscera {

/// Returns the material of a suture in a scene, with its material and size looked up.
ChainMaterial materialOf(const SutureConfig& config);
/// Returns the initial positions of its nodes: links of spacing_m along the path, and straight on where it is longer.
/// @throws SceneError  there is no path
std::vector<Vector3d> positionsOf(const SutureConfig& config);

}  // namespace viscera
