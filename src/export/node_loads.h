// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "export/cell_stress.h"
#include "viscera/model/model.h"
#include "viscera/solver/solver.h"

namespace viscera {

/// Strain and force at a node of tissue.
struct NodeLoad {
  Vector3f position_m;  ///< tissue frame
  float strain = 0;     ///< largest |stretch - 1| of the cells, or springs, around it
  /// Size of the force that balances the elastic forces around it [N]: at rest the weight and what tools, supports and
  /// other bodies put on it. From the stress of cells at their centroids.
  float force_n = 0;
};

/// Computes the loads of the nodes of all bodies. Keeps what does not change from moment to moment.
class NodeLoads {
 public:
  explicit NodeLoads(const Model& model);  ///< @param model  must outlive this
  const Model& model() const { return model_; }
  /// Returns the nodes that an uncut cell or spring holds.
  std::vector<NodeLoad> of(const HostState& state) const;

 private:
  struct Sums;
  void addCells(size_t body, const HostState& state, Sums& sums) const;
  void addSprings(const HostState& state, Sums& sums) const;

  const Model& model_;
  std::vector<std::unique_ptr<CellStresses>> stresses_;  ///< [bodies] null: no cells
};

}  // namespace viscera
