// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "viscera/api.h"
#include "viscera/model/model.h"

namespace VISCERA_PUBLIC viscera {

/// Thickness of the tissue behind a surface: quantiles 1 %, 10 % and 50 % over its area [m].
struct WallThickness {
  double least_m, tenth_m, median_m;
};

/// Returns the thickness of the tissue of a body with cells, measured straight inwards from its surface mesh at rest.
/// Returns nothing for other bodies and open surfaces.
std::optional<WallThickness> wallThickness(const Body& body);

/// Excess stiffness of thin curved walls, as a share of their displacement.
struct WallErrorRange {
  double least, most;  ///< error of a bent tube, and of an open bowl held at one side
};
/// Returns the error of walls of 3 mm as measured against CalculiX (docs/verification.md, Organs that hang).
/// @param cells  thickness of the wall over the spacing
/// @param walls  of the body's material
WallErrorRange expectedWallError(double cells, Walls walls = Walls::kCells);

/// Returns the thickness in cells that an open bowl needs for an error.
double cellsForWallError(double error, Walls walls = Walls::kCells);

/// Returns a text for users: thickness of walls in mm and in cells, the expected error, and how to reduce it.
std::string wallThicknessText(const WallThickness& thickness, double spacing_m, Walls walls);

/// Largest error of a thin wall that a body's notes do not mention.
constexpr double kNotedWallError = 0.05;

}  // namespace viscera
