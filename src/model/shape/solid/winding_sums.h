// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "model/shape/solid/solid_shell.h"
#include "viscera/model/shape/solid.h"

namespace viscera {

/// A cell that a shell's surface passes through, with the winding number and its moments integrated over the cell:
/// those of the tissue in it where the winding number is 0 or 1.
struct SurfaceCell {
  size_t cell;  ///< Solid::index()
  CellFill sum;
};

/// All cells that the surface of a shell touches, ascending. Exact but for rounding: no samples.
/// @param grid  covers the shell; its labels are not looked at
std::vector<SurfaceCell> windingSums(const Shell& shell, const Solid& grid);

}  // namespace viscera
