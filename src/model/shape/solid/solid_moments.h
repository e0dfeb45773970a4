// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "model/shape/solid/solid_volumes.h"

namespace viscera {

/// Labels the cells that contain tissue of some volumes, and computes the moments of partly filled cells.
/// @param volumes  smallest first: the first one gets a cell that several share
/// @param solid    an empty grid that covers them
void fillByMoments(const std::vector<Volume>& volumes, Solid& solid, const Progress& progress);

}  // namespace viscera
