// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "model/shape/organ/tissue.h"
#include "viscera/model/scene/body_config.h"

namespace viscera {

/// Nodes that the lattice of a solid has: corners of filled cells.
size_t countNodes(const Solid& solid);

/// The filling whose node count is nearest to a target, found by adjusting the spacing; 2 % ends the search.
/// @throws LatticeError  the nearest is more than 25 % off, or so fine a grid would not fit in memory
Filling fillToNodes(const Tissue& tissue, int target_nodes, const Progress& progress);

/// The membrane whose vertex count is nearest to a target, likewise.
TriangleMesh shellToNodes(const Tissue& tissue, int target_nodes);

/// The solid of a body as its target_nodes or else its spacing_m ask for; of an automatic spacing that has not been
/// chosen, with kUnmeasuredNodes nodes.
Filling fill(const Tissue& tissue, const BodyConfig& config, const Progress& progress);

}  // namespace viscera
