// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "solver/multigrid/levels/fine_level.h"

namespace viscera::multigrid {

/// Stiffness of an element on its eight corners, three axes each [N/m].
using ElementMatrix = Eigen::Matrix<float, 24, 24>;

/// Nodes of a level: integer coordinates, never negative, in the spacing of the level, and bodies.
struct LevelNodes {
  std::vector<Vector3i> at;
  std::vector<uint32_t> body;
};

/// A connected piece of a cell of the lattice: what live springs join. A cell that is cut through has two.
struct Element {
  Vector3i at;  ///< lowest corner
  uint32_t body = 0;
  uint32_t matrix = 0;             ///< in Elements::matrices
  std::array<int32_t, 8> nodes{};  ///< by corner (bits x, y, z); -1 where it has none
};

/// All that the lattice is made of.
struct Elements {
  LevelNodes nodes;
  std::vector<uint8_t> free;  ///< [nodes] others do not move
  std::vector<Element> elements;
  std::vector<ElementMatrix> matrices;  ///< shared by those that are alike
};

/// The lattice as it is, at rest: springs, cells, and the diagonal of the stage that is solved, spread over the
/// elements. Its nodes are those of the level's grid.
Elements elementsOf(const FineLevel& level);

}  // namespace viscera::multigrid
