// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "viscera/model/model.h"

namespace viscera {

/// Cell in a thin wall that is askew to the lattice. Its second derivatives along its own axes come from rows of nodes
/// (physics.md 1, Thin walls).
struct WallCell {
  uint32_t cell;           ///< slot of its lowest corner
  Eigen::Vector3d normal;  ///< unit normal of the wall in the lattice's axes; its sign has no meaning
  double rows;             ///< share of the second derivatives that comes from rows, 0..1; the rest is the cell's own
  double variation;        ///< share of their variation within the cell that counts, 0..kRowVariation
};

/// Largest share of the variation of second derivatives within a cell. With all of it motions are continuous, and
/// moderately thick walls become too stiff; with half of it pulled walls of half a cell are within 6 %.
constexpr double kRowVariation = 0.5;

/// Returns the cells of a body that lie in thin walls, ascending by cell: of lattices of the neo-Hookean law with
/// `walls: rows` and cells that are tissue in part, without a prestress; none of other bodies.
std::vector<WallCell> wallCells(const Body& body);

}  // namespace viscera
