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
/// (docs/volumes.md).
struct SurfaceNet {
  std::vector<Vector3d> positions_m;               ///< [vertices] positions in the frame of the volume [m]
  std::vector<std::array<uint32_t, 3>> triangles;  ///< counter-clockwise seen from sides[1]
  std::vector<std::array<uint8_t, 2>> sides;  ///< [triangles] labels behind and in front of the triangle; 0: outside
  size_t touching_edges = 0;  ///< number of edges where four triangles of one label meet, as its voxels only touch

  /// Returns the volume of a label [m3], by the divergence theorem.
  double volumeM3(uint8_t label) const;
};

/// Values of the scan that labels come from, where tissue is the set of values within a window.
struct ValueWindow {
  float low = 0, high = 0;
  std::function<float(size_t voxel)> value;  ///< returns the value of a voxel next to a border; NaN: unknown
};

/// Returns the surfaces of all labels. Voxels at the border of the volume are closed there.
/// @param window  if given, the surface is where the values cross it, not half way between voxels
/// @throws SceneError  labels do not fit the frame, or its axes span no volume
SurfaceNet surfaceNet(const LabelVolume& volume, const ValueWindow* window = nullptr);

/// Returns names for parts made of labels, [largest label + 1]. A part has the label's name; without a name, its value
/// in the file ("label 5"); if several labels have the same name, both.
std::vector<std::string> partNames(const std::vector<LabelName>& names);

/// Returns the closed surfaces of some labels as parts of one mesh, in this order, each facing outward. Labels that
/// touch share vertices. partNames() names the parts, which have the colours of their labels.
TriangleMesh labelSurfaces(const SurfaceNet& net, const std::vector<LabelName>& names,
                           const std::vector<uint8_t>& labels);

}  // namespace viscera
