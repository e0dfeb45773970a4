// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "solver/processes/clip/clips.h"
#include "solver/processes/pressure/lumen_network.h"

namespace viscera {

/// Returns [stations] whether a clip closes them: it reaches half a radius to both sides of the axis, with all that it
/// holds of the body along one tube or branch. It closes every station that it holds.
/// @param body  of the lumen
std::vector<uint8_t> clippedStations(const LumenNetwork& lumen, uint32_t body,
                                     const std::vector<Clips::Squeezed>& squeezed);

}  // namespace viscera
