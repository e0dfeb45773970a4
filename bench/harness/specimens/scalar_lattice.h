// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera::bench {

/// What SIMD is compared with: a plain loop over the nodes of one body, one after the other, on one thread, in float32.
/// The same equations as the other backends (physics.md 2: leapfrog on (u, v), extension without cancellation; with
/// a dashpot all springs are predicted, as mild ones are), the same counts per spring; nodes lie in a box with a
/// border, so that a neighbour is a constant away.
class ScalarLattice {
 public:
  /// @param model  one body of springs, without parts   @param start  state of time 0   @param dt_s  substep
  ScalarLattice(const Model& model, const HostState& start, double dt_s);
  void substep();
  size_t nodes() const { return active_.size(); }
  /// Displacements of the active nodes, in active-list order [m].
  std::vector<Vector3f> displacements() const;

 private:
  struct Node {
    std::array<float, 3> u_m, v_m_per_s;
  };
  struct Neighbor {
    std::ptrdiff_t offset;     ///< in the box
    std::array<float, 3> d_m;  ///< at rest
    float l0_m;
    float stiffness_n_per_m;  ///< of one count
  };
  template <bool kDashpot>
  void stepAll();
  template <bool kDashpot>
  std::array<float, 3> springForce(size_t at) const;

  std::vector<Node> nodes_, next_;      ///< [box]
  std::vector<layout::NodeBits> bits_;  ///< [box]
  std::vector<uint32_t> active_;        ///< [active] places in the box
  std::array<Neighbor, layout::kSpringsPerNode> neighbors_;
  layout::BodyParams body_;
  float dt_s_, kick_s_;
};

}  // namespace viscera::bench
