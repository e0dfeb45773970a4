// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "solver/multigrid/fine_level.h"

namespace viscera::multigrid {

/// Stiffness of an element on its eight corners, three axes each [N/m].
using ElementMatrix = Eigen::Matrix<float, 24, 24>;

/// A connected piece of a cell of a level: of the lattice itself what live springs join, of a coarser level what its
/// parts join. A cell that is cut through has two.
struct Element {
  Vector3i at;  ///< lowest corner, in cells of the level
  uint32_t body = 0;
  uint32_t matrix = 0;             ///< in Elements::matrices
  std::array<int32_t, 8> nodes{};  ///< of the level, by corner (bits x, y, z); -1 where it has none
};

/// All that a level is made of.
struct Elements {
  std::vector<Vector3i> node_at;    ///< [nodes]
  std::vector<uint32_t> node_body;  ///< [nodes]
  std::vector<uint8_t> node_free;   ///< [nodes] others do not move
  std::vector<Element> elements;
  std::vector<ElementMatrix> matrices;  ///< shared by those that are alike
};

/// The lattice as it is, at rest: springs, cells, and the diagonal of the stage that is solved, spread over the
/// elements. Its nodes are those of the level's grid.
Elements elementsOf(const FineLevel& level);

/// What a node of a level takes from those of the next coarser one, and the other way round.
struct Transfer {
  std::vector<uint32_t> starts, parents;          ///< [nodes + 1], [entries] coarse nodes of a node
  std::vector<float> weights;                     ///< [entries] 1, 1/2, 1/4 or 1/8
  std::vector<uint32_t> coarse_starts, children;  ///< [coarse nodes + 1], [entries] the same by coarse node
  std::vector<float> coarse_weights;
};

struct Coarsening {
  Elements coarse;
  Transfer transfer;
};

/// Merges cells 8 to 1: the pieces in them that share a node are one element, so that the sides of a cut stay apart.
/// Two of their corners at one place are one node if some node of the finer level takes from both. Matrices are P^T A
/// P, element by element; nodes that do not move take from nobody.
Coarsening coarsened(const Elements& fine);

}  // namespace viscera::multigrid
