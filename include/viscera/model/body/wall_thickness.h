// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "viscera/model/model.h"

namespace viscera {

/// Thickness of the tissue behind a surface: the least that 1 %, 10 % and half of its area have [m].
struct WallThickness {
  double least_m, tenth_m, median_m;
};

/// Returns the thickness of the tissue of a body with cells, straight in from its skin at rest; none for other bodies,
/// and where the surface is not closed.
std::optional<WallThickness> wallThickness(const Body& body);

/// How much too stiff thin curved walls are, as a share of their displacement.
struct WallErrorRange {
  double least, most;  ///< of a bent tube, and of an open bowl held at one side
};
/// Returns what was measured of walls of 3 mm beside CalculiX (docs/material.md, Beside finite elements).
/// @param cells  thickness of the wall over the spacing   @param walls  of the body's material
WallErrorRange expectedWallError(double cells, Walls walls = Walls::kCells);

/// Returns the thickness in cells that an open bowl needs for an error.
double cellsForWallError(double error, Walls walls = Walls::kCells);

/// Returns walls in mm and in cells, the error to expect, and what mends it, for a person.
std::string wallThicknessText(const WallThickness& thickness, double spacing_m, Walls walls);

/// Largest error of a thin wall that a body's notes do not mention.
constexpr double kNotedWallError = 0.05;

}  // namespace viscera
