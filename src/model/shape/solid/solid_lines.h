// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "model/shape/solid/solid_shell.h"
#include "viscera/model/shape/solid.h"

namespace viscera {

/// Interval inside a shell on a grid line, the line through the centres of a row of cells.
struct InsideStretch {
  int column_u, column_v;  ///< row: cell coordinates along axes (axis + 1) % 3 and (axis + 2) % 3
  double from, to;         ///< cell coordinates along the axis; the centre of cell i is at i + 0.5
  bool head_on;            ///< both ends cross the surface within about 55 degrees of its normal
  int winding;             ///< winding number along the interval: 1, -1, ...; 0 where it changes
};

/// Returns the intervals of all grid lines along `axis` where the winding number of the shell is not zero.
/// @param grid  its labels are ignored
std::vector<InsideStretch> insideStretches(const Shell& shell, const Solid& grid, int axis);

}  // namespace viscera
