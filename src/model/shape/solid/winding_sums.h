// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "model/shape/solid/solid_shell.h"
#include "viscera/model/shape/solid.h"

namespace viscera {

/// Cell with a shell's surface in it, and the integrals of the winding number and its moments over the cell. They are
/// those of the tissue in it where the winding number is 0 or 1.
struct SurfaceCell {
  size_t cell;  ///< Solid::index()
  CellFill sum;
};

/// Returns all cells that the surface of a shell touches, ascending. Exact up to rounding: no samples.
/// @param grid  covers the shell; its labels are ignored
std::vector<SurfaceCell> windingSums(const Shell& shell, const Solid& grid);

}  // namespace viscera
