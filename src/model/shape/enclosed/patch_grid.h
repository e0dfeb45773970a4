// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// A grid of points around a bag of triangles, however these are turned, and whatever gaps are between them.
class PatchGrid {
 public:
  /// @param reach_m  room around the triangles [m]; `distance_m` is known this far
  PatchGrid(const TriangleMesh& mesh, double step_m, double reach_m);

  double step_m;
  Vector3d origin_m;               ///< point (0, 0, 0)
  Vector3i size;                   ///< points
  std::vector<float> distances_m;  ///< [points] to the nearest triangle; beyond 1.5 steps to half a step

  size_t points() const { return distances_m.size(); }
  size_t stride(int axis) const {
    return axis == 0 ? 1 : axis == 1 ? size.x() : static_cast<size_t>(size.x()) * size.y();
  }
  int along(size_t point, int axis) const { return static_cast<int>(point / stride(axis) % size[axis]); }

  /// Whether a triangle lies between a point and the next one along an axis.
  bool crossed(size_t point, int axis) const { return crossed_[point] >> axis & 1; }
  /// Where the first and the last one does, as shares of the way; both 1/2 where none does.
  std::array<float, 2> crossings(size_t point, int axis) const;

 private:
  void addDistances(const std::array<Vector3d, 3>& corners);
  void addCrossings(const std::array<Vector3d, 3>& corners, int axis);
  void goOn();

  std::vector<uint8_t> crossed_;                            ///< [points] a bit for each axis
  std::unordered_map<size_t, std::array<float, 2>> where_;  ///< [3 point + axis]
};

/// Distance [steps] of each point to the nearest one that is marked: exact, by lower envelopes of parabolas.
std::vector<float> distancesTo(const std::vector<uint8_t>& marked, const PatchGrid& grid);

}  // namespace viscera
