// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "model/shape/solid/solid_volumes.h"

namespace viscera {

/// Labels the cells that hold tissue of some volumes, and finds the moments of those that are tissue in part.
/// @param volumes  smallest first: it is whose a cell is that several have
/// @param solid    an empty grid that covers them
void fillByMoments(const std::vector<Volume>& volumes, Solid& solid, const Progress& progress);

}  // namespace viscera
