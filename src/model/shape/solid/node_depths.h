// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "model/shape/solid/solid_volumes.h"

namespace viscera {

// Depths below the true surface of the nodes around partly filled cells. Contacts need them, as outer nodes are up to a
// cell's diagonal outside the surface.

/// Measures depths to the nearest triangle of any part: exact, but too small where a part ends inside another one.
void measureDepths(const std::vector<Volume>& volumes, Solid& solid);
/// Measures depths by the field itself, as exactly as it represents a distance.
void measureDepths(const DistanceField& field, Solid& solid);

}  // namespace viscera
