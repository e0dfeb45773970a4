// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Returns the approximate number of triangles that refine() makes of a mesh, within a factor of about two, without
/// making them.
double refinedTriangles(const TriangleMesh& mesh, double longest_edge_m);

/// Checks the size of the surface mesh. It is divided to the lattice's spacing, so a stray sheet next to an organ can
/// cost more than the organ.
/// @param most  bodies[].import_limits.max_triangles
/// @throws LatticeError  there would be more triangles; names their number, the part with most of them, and the
/// remedies
void requireSkinSize(const TriangleMesh& mesh, double spacing_m, int most);

}  // namespace viscera
