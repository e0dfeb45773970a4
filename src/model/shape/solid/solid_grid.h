// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "viscera/model/shape/solid.h"

namespace viscera {

/// Returns an empty solid with cells that cover a box. The cells are centred on the box, so that a box of whole cells
/// fits exactly, or placed by `planes`.
/// @throws LatticeError  spacing not a finite number > 0, larger than the box, or the grid would not fit in memory
Solid emptySolid(const Vector3d& min_m, const Vector3d& max_m, double spacing_m,
                 const std::vector<std::string>& part_names, const NodePlanes& planes = {});

/// Checks a spacing. @throws LatticeError  spacing not a finite number > 0
void requireSpacing(double spacing_m);

/// Checks a spacing.
/// @throws LatticeError  spacing not a finite number > 0, or larger than a body of this size in every direction
void requireSpacingWithin(const Vector3d& size_m, double spacing_m);

/// Looks for a finer spacing with fills(spacing_m), after a spacing at which no cell was filled.
/// @throws LatticeError  there is one; names it
void requireFinerSpacing(double spacing_m, const std::function<bool(double)>& fills);

}  // namespace viscera
