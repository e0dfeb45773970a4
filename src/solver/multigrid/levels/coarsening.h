// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/multigrid/levels/block_matrix.h"
#include "solver/multigrid/levels/interpolation.h"

namespace viscera::multigrid {

/// The next coarser level of one: matrix P^T A P (U. Trottenberg et al., Multigrid, 2001) [N/m].
struct Coarsening {
  LevelNodes nodes;
  Transfer transfer;
  BlockMatrix matrix;
};

/// Of the lattice. Nodes that do not move take from none.
Coarsening coarsened(const Elements& lattice);
/// Of a coarse level.
Coarsening coarsened(const LevelNodes& nodes, const BlockMatrix& matrix);

}  // namespace viscera::multigrid
