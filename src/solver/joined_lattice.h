// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/model/model.h"
#include "viscera/solver/material.h"

namespace viscera {

// The lattices of all bodies of a model as one, as every backend holds it: slots of body b behind those of the bodies
// before it.

/// [active] slots of nodes, ascending
std::vector<uint32_t> activeSlots(const Model& model);
/// [cells] slots of the lowest corners of filled cells, ascending
std::vector<uint32_t> cellSlots(const Model& model);
/// [bricks] neighbours numbered over all bodies
std::vector<layout::Brick> allBricks(const Model& model);
/// [slots] whole springs, nothing held, with the body's index
std::vector<layout::NodeBits> allNodes(const Model& model);
/// strengths() of all bodies: spring_n_per_m [9 * slots], mass_kg [slots], bulk_j [slots]
Strengths allStrengths(const Model& model);

}  // namespace viscera
