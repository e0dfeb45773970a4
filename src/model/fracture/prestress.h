// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "viscera/model/model.h"

namespace viscera {

// material.prestress (docs/cutting.md 6): all of it is in the rest lengths of a body's explicit connections.

/// Gives the springs of a body, whose nodes are fixed already, the rest lengths that its prestress asks for, as far as
/// they balance in the shape that the body has; a note says how far. Without a prestress nothing is done.
/// @throws SceneError  springs would have to be shorter or longer at rest than they bear; names body and key
void addPrestress(Body& body);

/// [slots] stress at rest over the cell's mu, of the cell whose lowest corner is the node; empty: the body has none.
std::vector<Eigen::Matrix3d> cellPrestresses(const Body& body);

}  // namespace viscera
