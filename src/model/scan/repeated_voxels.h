// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "model/scan/volume.h"

namespace viscera {

/// Refinement of a label map along one axis without more detail: every voxel repeated.
struct Repeats {
  int times = 1;  ///< number of repeats; 1: not refined
  int first = 0;  ///< smallest index at which a new voxel begins, below `times`
};

/// Returns the repeats along i, j and k; 1 along an axis with too few borders to decide.
std::array<Repeats, 3> repeatsOf(const LabelVolume& map);

/// Returns the map with each voxel once, at its position before the refinement.
LabelVolume withoutRepeats(const LabelVolume& map, const std::array<Repeats, 3>& repeats);

}  // namespace viscera
