// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// What a bag of triangles encloses, whichever way these are turned (docs/fill_rule.md, `fill: enclosed`).
struct EnclosedSurface {
  TriangleMesh mesh;  ///< closed, facing outward; one part, "enclosed"
  double volume_m3 = 0;
  double closed_gap_m = 0;  ///< gaps up to this width were closed
  double hole_m = 0;        ///< some hole through which it would have run out is about this wide; 0: none was found
  bool settled = true;      ///< false: gaps as wide as `gap_m` still made a difference
  double step_m = 0;        ///< of the grid that it was found on
  double asked_step_m = 0;  ///< smaller where that grid would have had too many points
  double most_points = 0;   ///< of a grid
  double fine_gap_m = 0;    ///< where it is: the widest `gap_m` that leaves a grid of that step; negative: none does

  std::string text() const;
};

constexpr double kMostGridPoints = 20e6;  ///< some 400 MB

/// @param step_m  of the grid that it is found on; made larger where there would be more than `most_points`
/// @param gap_m   the widest gap that is closed
/// @throws MeshError  nothing is enclosed
EnclosedSurface enclosedSurface(const TriangleMesh& mesh, double step_m, double gap_m,
                                double most_points = kMostGridPoints);

}  // namespace viscera
