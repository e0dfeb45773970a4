// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "model/scan/surface_net.h"

namespace viscera {

/// A net before it is smoothed: quads between voxels of different labels, whose corners lie in the dual cells (2 x 2 x
/// 2 voxels) around them.
struct NetCells {
  std::vector<Vector3d> places_m;              ///< [vertices] along the axes of the voxels, voxel (0, 0, 0) at 0
  std::vector<std::array<uint32_t, 4>> quads;  ///< counter-clockwise seen from sides[1], in a right-handed frame
  std::vector<std::array<uint8_t, 2>> sides;   ///< [quads] label behind and before it
};

/// @param window  where given, corners lie where values cross it, else in the middle of their cell
NetCells netCells(const LabelVolume& volume, const ValueWindow* window);

}  // namespace viscera
