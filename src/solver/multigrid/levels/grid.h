// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "math/aligned.h"
#include "solver/multigrid/levels/fine_kernels.h"
#include "viscera/model/model.h"

namespace viscera::multigrid {

/// Where the nodes of implicit lattices lie in the arrays of the finest level: each body in its bounding box, x
/// fastest, so that a neighbour is at the same distance for every node of a body. Places without a node hold zeros.
class Grid {
 public:
  /// Nodes of bodies with explicit connections are not in it.
  explicit Grid(const Model& model);

  size_t places() const { return places_; }  ///< floats per component
  size_t nodeCount() const { return slots.size(); }
  uint32_t bodyOf(uint32_t node) const { return body_of_[node]; }
  /// Place of the neighbour of a place in a body.
  size_t beside(uint32_t body, size_t place, int x, int y, int z) const {
    return static_cast<size_t>(static_cast<ptrdiff_t>(place) + x + y * bodies[body].row + z * bodies[body].layer);
  }

  std::vector<Box> bodies;         ///< [bodies] without material constants; unused ones have no node
  std::vector<uint32_t> slots;     ///< [nodes] of the solver, ascending
  std::vector<uint32_t> place_of;  ///< [nodes] place
  std::vector<int32_t> node_at;    ///< [places] node, -1 none
  std::vector<Vector3i> at;        ///< [nodes] integer coordinates in their body
  std::vector<Block> blocks;       ///< that have nodes, ascending: vectors of kBlock places

 private:
  size_t places_ = 0;
  std::vector<uint32_t> body_of_;
};

}  // namespace viscera::multigrid
