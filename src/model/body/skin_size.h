// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// Triangles that refine() makes of a mesh, about: within a factor of two or so, and without making them.
double refinedTriangles(const TriangleMesh& mesh, double longest_edge_m);

/// A skin is divided to the lattice's spacing, so a sheet that strayed beside an organ can cost more than the organ.
/// @param most  bodies[].import_limits.max_triangles
/// @throws LatticeError  there would be more triangles; names how many, the part with most of them, the ways out
void requireSkinSize(const TriangleMesh& mesh, double spacing_m, int most);

}  // namespace viscera
