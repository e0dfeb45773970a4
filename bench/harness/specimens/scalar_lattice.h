// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera::bench {

/// Scalar baseline for SIMD: a plain loop over the nodes of one body on one thread in float32. It solves the same
/// equations as the backends (physics.md 2: leapfrog on (u, v), extension without cancellation; with a dashpot all
/// springs are predicted, as mild ones are) with the same counts per spring. Nodes are in a box with a border, so
/// neighbours have constant offsets.
class ScalarLattice {
 public:
  /// @param model  one body of springs, without parts   @param start  initial state   @param dt_s  substep
  ScalarLattice(const Model& model, const HostState& start, double dt_s);
  void substep();
  size_t nodes() const { return active_.size(); }
  /// Returns the displacements of the active nodes, in active-list order [m].
  std::vector<Vector3f> displacements() const;

 private:
  struct Node {
    std::array<float, 3> u_m, v_m_per_s;
  };
  struct Neighbor {
    std::ptrdiff_t offset;     ///< offset in the box
    std::array<float, 3> d_m;  ///< vector to the neighbour at rest [m]
    float l0_m;
    float stiffness_n_per_m;  ///< stiffness of one count [N/m]
  };
  template <bool kDashpot>
  void stepAll();
  template <bool kDashpot>
  std::array<float, 3> springForce(size_t at) const;

  std::vector<Node> nodes_, next_;      ///< [box] nodes; state of the next substep
  std::vector<layout::NodeBits> bits_;  ///< [box] springs of the nodes
  std::vector<uint32_t> active_;        ///< [active] indices in the box
  std::array<Neighbor, layout::kSpringsPerNode> neighbors_;
  layout::BodyParams body_;
  float dt_s_, kick_s_;
};

}  // namespace viscera::bench
