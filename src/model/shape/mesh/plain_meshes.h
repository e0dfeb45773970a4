// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Sides of a sheet along y: toothed, as the shifted rows leave them, or straight. For straight sides the first and
/// last node of every row move by a quarter of a spacing to x = +-(columns - 1) / 2 spacings, which lowers the stable
/// substep to 0.80.
enum class SheetSides { kToothed, kStraight };

/// Returns a flat sheet in z = 0 of equilateral triangles, centred on the origin, facing +z. Rows are along x, every
/// other one shifted by half a spacing; node (row, column) is at row * columns + column. Inner nodes have six
/// neighbours. All edges have the length `spacing_m`, except those at straight sides.
/// @param rows, columns  of nodes, each at least 2
TriangleMesh sheetMesh(int rows, int columns, double spacing_m, SheetSides sides = SheetSides::kToothed);

/// Rows and columns of the sheet with straight sides that is nearest to a size, at least 2 of each.
struct SheetGrid {
  int rows, columns;
};
SheetGrid sheetGrid(double size_x_m, double size_y_m, double spacing_m);

/// Returns a closed ball around the origin: an icosahedron with its faces divided into triangles with edges of about
/// `spacing_m`, on the sphere. 12 nodes have five neighbours, all others six.
TriangleMesh ballMesh(double radius_m, double spacing_m);

}  // namespace viscera
