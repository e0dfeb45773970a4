// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/shape/solid.h"

namespace viscera {

/// Fills the region that a set of triangles encloses, from all parts together (docs/volumes.md, `fill: enclosed`).
/// Parts are regions of it. A closed part has the cells with centres in it, the smallest first. Any other part has the
/// cells that its triangles pass through. The rest is the part "enclosed".
/// @param moments  true: as voxeliseByMoments(), else as voxelise()
/// @param note     a line on what was closed
/// @throws LatticeError, MeshError  as these
Solid voxeliseEnclosed(const TriangleMesh& mesh, double spacing_m, double gap_m, bool moments, const NodePlanes& planes,
                       std::string& note, const Progress& progress = {});

}  // namespace viscera
