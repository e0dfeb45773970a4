// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "model/scan/surface_net.h"

namespace viscera {

/// Net before smoothing: quads between voxels of different labels, with corners in the dual cells (2 x 2 x 2 voxels)
/// around them.
struct NetCells {
  std::vector<Vector3d> positions_m;  ///< [vertices] positions along the axes of the voxels, voxel (0, 0, 0) at 0 [m]
  std::vector<std::array<uint32_t, 4>> quads;  ///< counter-clockwise seen from sides[1], in a right-handed frame
  std::vector<std::array<uint8_t, 2>> sides;   ///< [quads] labels behind and in front of the quad
};

/// Returns the share of the step from a voxel to the next one along an axis at which the surface is, where their labels
/// differ. The voxel, or the next one, may be one beyond the volume.
using Crossing = std::function<double(const Vector3i& voxel, int axis)>;

/// Returns the net of a volume.
/// @param crossing  if given, corners are at the mean of the crossings around them, else at the centre of their cell
NetCells netCells(const LabelVolume& volume, const Crossing& crossing = {});

/// Returns the net without smoothing (`touching_edges` is not counted).
/// @throws SceneError  as surfaceNet()
SurfaceNet plainNet(const LabelVolume& volume, const Crossing& crossing);

}  // namespace viscera
