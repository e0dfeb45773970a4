// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/shape/solid.h"

namespace viscera {

/// Fills what a bag of triangles encloses, from all parts together (docs/fill_rule.md, `fill: enclosed`). Parts are
/// regions of it: a closed one has the cells whose centre it holds, the smallest first; any other those that its
/// triangles pass through. What is left is the part "enclosed".
/// @param moments  as voxeliseByMoments(), else as voxelise()
/// @param note     a line on what was closed
/// @throws LatticeError, MeshError  as these
Solid voxeliseEnclosed(const TriangleMesh& mesh, double spacing_m, double gap_m, bool moments, const NodePlanes& planes,
                       std::string& note, const Progress& progress = {});

}  // namespace viscera
