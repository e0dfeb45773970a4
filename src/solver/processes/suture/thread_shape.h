// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/processes/suture/chain/chain.h"
#include "viscera/model/scene/thread_config.h"

namespace viscera {

/// What a scene says of a thread, its material and size looked up.
ChainMaterial materialOf(const ThreadConfig& config);
/// Its nodes at first: links of spacing_m along the path, and straight on where it is longer.
/// @throws SceneError  there is no path
std::vector<Vector3d> placesOf(const ThreadConfig& config);

}  // namespace viscera
