// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Grid of points around a set of triangles of any orientation, with any gaps between them.
class PatchGrid {
 public:
  /// @param reach_m  margin around the triangles [m]; `distance_m` is known up to it
  PatchGrid(const TriangleMesh& mesh, double step_m, double reach_m);

  double step_m;
  Vector3d origin_m;  ///< position of point (0, 0, 0)
  Vector3i size;      ///< number of points
  /// [points] distance to the nearest triangle [m]; beyond 1.5 steps accurate to half a step.
  std::vector<float> distances_m;

  size_t points() const { return distances_m.size(); }
  size_t stride(int axis) const {
    return axis == 0 ? 1 : axis == 1 ? size.x() : static_cast<size_t>(size.x()) * size.y();
  }
  int along(size_t point, int axis) const { return static_cast<int>(point / stride(axis) % size[axis]); }

  /// Returns whether a triangle is between a point and the next one along an axis.
  bool crossed(size_t point, int axis) const { return crossed_[point] >> axis & 1; }
  /// Returns where the first and the last triangle crosses, as shares of the step; both 1/2 where none does.
  std::array<float, 2> crossings(size_t point, int axis) const;

 private:
  void addDistances(const std::array<Vector3d, 3>& corners);
  void addCrossings(const std::array<Vector3d, 3>& corners, int axis);
  void goOn();

  std::vector<uint8_t> crossed_;                            ///< [points] one bit for each axis
  std::unordered_map<size_t, std::array<float, 2>> where_;  ///< by [3 point + axis]
};

/// Returns the distance [steps] of each point to the nearest marked one: exact, by lower envelopes of parabolas.
std::vector<float> distancesTo(const std::vector<uint8_t>& marked, const PatchGrid& grid);

}  // namespace viscera
