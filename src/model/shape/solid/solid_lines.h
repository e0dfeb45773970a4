// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "model/shape/solid/solid_shell.h"
#include "viscera/model/shape/solid.h"

namespace viscera {

/// A stretch of a grid line, the line through the centres of a row of cells, that runs inside a shell.
struct InsideStretch {
  int column_u, column_v;  ///< the row: cell coordinates along axes (axis + 1) % 3 and (axis + 2) % 3
  double from, to;         ///< cell coordinates along the axis; the centre of cell i is at i + 0.5
  bool head_on;            ///< both ends cross the surface within about 55 degrees of its normal
  int winding;             ///< number of all of it: 1, -1, ...; 0 where it changes on the way
};

/// Stretches of all grid lines along `axis` where the winding number of the shell is not zero.
/// @param grid  its labels are not looked at
std::vector<InsideStretch> insideStretches(const Shell& shell, const Solid& grid, int axis);

}  // namespace viscera
