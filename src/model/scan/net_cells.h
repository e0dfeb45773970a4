// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
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

/// Share of the way from a voxel to the next one along an axis at which the surface lies, where their labels differ.
/// The voxel, or the next one, may lie one beyond the volume.
using Crossing = std::function<double(const Vector3i& voxel, int axis)>;

/// @param crossing  where given, corners lie in the middle of the crossings around them, else of their cell
NetCells netCells(const LabelVolume& volume, const Crossing& crossing = {});

/// The net as it is, without smoothing (`touching_edges` are not counted).
/// @throws SceneError  as surfaceNet()
SurfaceNet plainNet(const LabelVolume& volume, const Crossing& crossing);

}  // namespace viscera
