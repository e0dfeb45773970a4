// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "model/shape/organ/tissue.h"
#include "viscera/model/scene/body_config.h"

namespace viscera {

/// Returns the number of nodes of a solid's lattice: corners of filled cells.
size_t countNodes(const Solid& solid);

/// Returns the filling with a node count nearest to a target, found by adjusting the spacing; 2 % ends the search.
/// @throws LatticeError  the nearest is more than 25 % off, or so fine a grid would not fit in memory
Filling fillToNodes(const Tissue& tissue, int target_nodes, const Progress& progress);

/// Returns the membrane with a vertex count nearest to a target, in the same way.
TriangleMesh shellToNodes(const Tissue& tissue, int target_nodes);

/// Returns the solid of a body at its target_nodes or else its spacing_m; kUnmeasuredNodes nodes for an automatic
/// spacing that has not been chosen.
Filling fill(const Tissue& tissue, const BodyConfig& config, const Progress& progress);

}  // namespace viscera
