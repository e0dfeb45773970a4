// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "viscera/api.h"
#include "viscera/model/model.h"

namespace VISCERA_PUBLIC viscera {

/// Cell in a thin wall that is oblique to the lattice. Its second derivatives along its own axes come from rows of
/// nodes (physics.md 1, Thin walls).
struct WallCell {
  uint32_t cell;           ///< slot of its lowest corner
  Eigen::Vector3d normal;  ///< unit normal of the wall in the lattice's axes; its sign has no meaning
  double rows;  ///< share of the second derivatives that comes from rows, 0..1; the rest comes from the cell itself
  double variation;  ///< share of their variation within the cell that is used, 0..kRowVariation
};

/// Largest share of the variation of second derivatives within a cell: that of walls of half a cell, which are within 6
/// % under tension with it. With all of it motions would be continuous, but walls too stiff.
constexpr double kRowVariation = 0.5;

/// Returns the cells of a body in thin walls, ascending by cell. Only lattices of the neo-Hookean law with `walls:
/// rows`, partly filled cells and no prestress have any.
std::vector<WallCell> wallCells(const Body& body);

/// Adds ghosts to a body with such cells: one for each fixed corner of such a cell where a row of nodes leaves the
/// clamp and no node lies beyond. A slot is the ghost of one node only.
void addRowGhosts(Body& body);

}  // namespace viscera
