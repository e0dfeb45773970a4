// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "model/scan/volume.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Smooth surfaces of all labels of a map at once: where two labels touch, both have the same triangles
/// (docs/surface_net.md).
struct SurfaceNet {
  std::vector<Vector3d> positions_m;               ///< [vertices] in the frame of the volume
  std::vector<std::array<uint32_t, 3>> triangles;  ///< counter-clockwise seen from sides[1]
  std::vector<std::array<uint8_t, 2>> sides;       ///< [triangles] label behind and before it; 0: outside
  size_t touching_edges = 0;  ///< where voxels of one label touch along an edge only: four of its triangles meet there

  /// Of a label [m3], by the divergence theorem.
  double volumeM3(uint8_t label) const;
};

/// Values of the scan that labels come from, where tissue is what lies within a window.
struct ValueWindow {
  float low = 0, high = 0;
  std::function<float(size_t voxel)> value;  ///< asked of voxels beside a border only; NaN: unknown
};

/// Voxels at the border of the volume are closed there.
/// @param window  where given, the surface is where the values cross it rather than half way between voxels
/// @throws SceneError  labels do not fit the frame, or its axes span no volume
SurfaceNet surfaceNet(const LabelVolume& volume, const ValueWindow* window = nullptr);

/// [largest label + 1] what parts that are labels are called: by their names, those without one by their value in the
/// file ("label 5"), those whose name others have too by both.
std::vector<std::string> partNames(const std::vector<LabelName>& names);

/// The closed surfaces of some labels as parts of one mesh, in this order, each facing outward. Labels that touch share
/// vertices. Parts are named as partNames() has it.
TriangleMesh labelSurfaces(const SurfaceNet& net, const std::vector<LabelName>& names,
                           const std::vector<uint8_t>& labels);

}  // namespace viscera
