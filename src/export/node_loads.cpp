// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/node_loads.h"

#include <algorithm>
#include <cmath>

#include "export/uncut_cells.h"
#include "math/decompositions.h"
#include "math/vec4.h"

namespace viscera {

/// [slots of the model]
struct NodeLoads::Sums {
  explicit Sums(size_t slots) : force_n(slots, Vector3d::Zero()), strain(slots, -1) {}
  void stretch(size_t slot, double of) { strain[slot] = std::max(strain[slot], static_cast<float>(of)); }
  std::vector<Vector3d> force_n;
  std::vector<float> strain;  ///< below 0: nothing holds the node
};

NodeLoads::NodeLoads(const Model& model) : model_(model) {
  for (const Body& body : model.bodies)  // an explicit lattice has cells, but its springs carry it
    stresses_.push_back(body.hasCells() && !body.network ? std::make_unique<CellStresses>(body) : nullptr);
}

void NodeLoads::addCells(size_t b, const HostState& state, Sums& sums) const {
  const Body& body = model_.bodies[b];
  const uint32_t offset = model_.slotOffset(b);
  const double h_m = body.lattice.spacing_m;
  forUncutCells(body, *stresses_[b], offset, state, [&](const UncutCell& cell) {
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    std::array<Vector3d, 8> sides;
    for (size_t c = 0; c < 8; ++c) {
      sides[c] = Vector3d(c & 1 ? 1 : -1, c >> 1 & 1 ? 1 : -1, c >> 2 & 1 ? 1 : -1);
      f += cell.u_m[c] * sides[c].transpose() / (4 * h_m);
    }
    const Vector3d squares = principalValues(f.transpose() * f);
    double stretch = 0;
    for (int i = 0; i < 3; ++i) stretch = std::max(stretch, std::abs(std::sqrt(std::max(squares[i], 0.0)) - 1));
    // Forces of the cell on its corners are -h^2 / 4 P s: P = sigma cof F is the first Piola-Kirchhoff stress.
    Eigen::Matrix3d cofactors;
    for (int a = 0; a < 3; ++a) cofactors.col(a) = f.col((a + 1) % 3).cross(f.col((a + 2) % 3));
    const Eigen::Matrix3d first_pa = cell.stress.cauchy_pa * cofactors;
    for (size_t c = 0; c < 8; ++c) {
      sums.force_n[offset + cell.corners[c]] += h_m * h_m / 4 * first_pa * sides[c];
      sums.stretch(offset + cell.corners[c], stretch);
    }
  });
}

void NodeLoads::addSprings(const HostState& state, Sums& sums) const {
  forUncutSprings(model_, state, [&](size_t b, const NetworkSpring& spring, const Vector3d& step_m) {
    const double length_m = step_m.norm();
    if (!(length_m > 0)) return;
    const uint32_t offset = model_.slotOffset(b);
    const double longer_m = length_m - spring.rest_length_m;
    const Vector3d force_n = spring.stiffness_n_per_m * longer_m / length_m * step_m;
    sums.force_n[offset + spring.b] += force_n;
    sums.force_n[offset + spring.a] -= force_n;
    for (const uint32_t end : {spring.a, spring.b})
      sums.stretch(offset + end, std::abs(longer_m) / spring.rest_length_m);
  });
}

std::vector<NodeLoad> NodeLoads::of(const HostState& state) const {
  Sums sums(model_.slots());
  for (size_t b = 0; b < model_.bodies.size(); ++b)
    if (stresses_[b]) addCells(b, state, sums);
  addSprings(state, sums);
  std::vector<NodeLoad> out;
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const uint32_t first = model_.slotOffset(b), end = model_.slotOffset(b + 1);
    for (uint32_t slot = first; slot < end; ++slot) {
      if (sums.strain[slot] < 0) continue;
      const Vector3d at_m = restPosition(model_.bodies[b], slot - first) + xyz(state.displacement_m[slot]);
      out.push_back({at_m.cast<float>(), sums.strain[slot], static_cast<float>(sums.force_n[slot].norm())});
    }
  }
  return out;
}

}  // namespace viscera
