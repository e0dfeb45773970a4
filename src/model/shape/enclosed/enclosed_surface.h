// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Region that a set of triangles of any orientation encloses (docs/volumes.md, `fill: enclosed`).
struct EnclosedSurface {
  TriangleMesh mesh;  ///< closed and facing outward; one part, "enclosed"
  double volume_m3 = 0;
  double closed_gap_m = 0;  ///< largest width of the gaps that were closed [m]
  double hole_m = 0;        ///< approximate width of a hole through which the inside would leak [m]; 0: none found
  bool settled = true;      ///< false: closing gaps as wide as `gap_m` still changed the result
  double step_m = 0;        ///< step of the grid [m]
  double asked_step_m = 0;  ///< requested step [m]; smaller than step_m where that grid would have had too many points
  double most_points = 0;   ///< largest number of points of a grid
  double fine_gap_m = 0;    ///< if step_m was enlarged: widest `gap_m` for the requested step [m]; negative: none

  std::string text() const;
};

constexpr double kMostGridPoints = 20e6;  ///< about 400 MB

/// Finds the region that a mesh encloses.
/// @param step_m  step of the grid; enlarged if there would be more than `most_points`
/// @param gap_m   the widest gap that is closed
/// @throws MeshError  nothing is enclosed
EnclosedSurface enclosedSurface(const TriangleMesh& mesh, double step_m, double gap_m,
                                double most_points = kMostGridPoints);

}  // namespace viscera
