// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "model/scan/volume.h"

namespace viscera {

/// How a label map was made finer along one axis without more detail: every voxel repeated.
struct Repeats {
  int times = 1;  ///< 1: it was not
  int first = 0;  ///< the least index at which another voxel begins, below `times`
};

/// Returns the repeats along i, j and k; 1 along an axis with few borders, which say nothing.
std::array<Repeats, 3> repeatsOf(const LabelVolume& map);

/// Returns the map with each voxel once, where it was before it was made finer.
LabelVolume withoutRepeats(const LabelVolume& map, const std::array<Repeats, 3>& repeats);

}  // namespace viscera
