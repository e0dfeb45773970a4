// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/specimens/scalar_lattice.h"

#include <cmath>

#include "viscera/solver/material.h"

namespace viscera::bench {

namespace {

constexpr int kBorder = 1;  // width on every side of the box

}  // namespace

ScalarLattice::ScalarLattice(const Model& model, const HostState& start, double dt_s)
    : body_(bodyParams(model.bodies[0], safeTimeStep(model))),
      dt_s_(static_cast<float>(dt_s)),
      kick_s_(static_cast<float>(0.5 * dt_s)) {
  const Lattice& lattice = model.bodies[0].lattice;
  const Vector3i size = lattice.nodes_per_axis.array() + 2 * kBorder;
  const auto positionOf = [&](const Vector3i& node) {
    return node.x() + size.x() * (node.y() + static_cast<std::ptrdiff_t>(size.y()) * node.z());
  };
  const size_t positions = static_cast<size_t>(positionOf({0, 0, size.z()}));
  nodes_.resize(positions);
  bits_.resize(positions);
  for (uint32_t slot : lattice.active_slots) {
    const size_t at = static_cast<size_t>(positionOf(lattice.nodeAt(slot).array() + kBorder));
    const layout::vec4 &u = start.displacement_m[slot], &v = start.velocity_m_per_s[slot];
    active_.push_back(static_cast<uint32_t>(at));
    nodes_[at] = {{u.x, u.y, u.z}, {v.x, v.y, v.z}};
    bits_[at] = start.nodes[slot];
  }
  next_ = nodes_;
  const float h = body_.origin_spacing.w;
  for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
    const auto& o = kNeighborOffsets[s];
    const float length = isAxial(s) ? h : std::sqrt(2.0f) * h;
    neighbors_[s] = {positionOf({o[0], o[1], o[2]}),
                     {h * static_cast<float>(o[0]), h * static_cast<float>(o[1]), h * static_cast<float>(o[2])},
                     length,
                     isAxial(s) ? body_.axial_quarter_n_per_m : body_.diagonal_half_n_per_m};
  }
}

/// Returns the sum of k (L - l0) n, L - l0 = (2 d.w + w.w) / (L + l0); dashpots use the predicted ends.
template <bool kDashpot>
std::array<float, 3> ScalarLattice::springForce(size_t at) const {
  const Node& near = nodes_[at];
  const layout::NodeBits bits = bits_[at];
  std::array<float, 3> force{};
  for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
    const uint32_t count = springCount(bits, s);
    if (count == 0) continue;
    const Neighbor& spring = neighbors_[s];
    const Node& far = nodes_[static_cast<size_t>(static_cast<std::ptrdiff_t>(at) + spring.offset)];
    float w[3], e[3], dw = 0, ww = 0, ee = 0;
    for (int i = 0; i < 3; ++i) {
      w[i] = far.u_m[i] - near.u_m[i];
      if (kDashpot) w[i] += body_.dashpot_s * (far.v_m_per_s[i] - near.v_m_per_s[i]);
      e[i] = spring.d_m[i] + w[i];
      dw += spring.d_m[i] * w[i];
      ww += w[i] * w[i];
      ee += e[i] * e[i];
    }
    const float k = static_cast<float>(count) * spring.stiffness_n_per_m, length = std::sqrt(ee);
    const float pull = k * (2 * dw + ww) / (length * (length + spring.l0_m));
    for (int i = 0; i < 3; ++i) force[i] += pull * e[i];
  }
  return force;
}

template <bool kDashpot>
void ScalarLattice::stepAll() {
  const float g = 0.5f * body_.mass_damping_per_s * kick_s_;
  for (uint32_t at : active_) {
    if (isFixed(bits_[at])) continue;
    const std::array<float, 3> force = springForce<kDashpot>(at);
    const float mobility = 1 / (static_cast<float>(massEighths(bits_[at])) * body_.mass_eighth_kg);
    const Node& node = nodes_[at];
    Node& next = next_[at];
    for (int i = 0; i < 3; ++i) {
      const float v = node.v_m_per_s[i];
      next.v_m_per_s[i] = v + (kick_s_ * mobility * force[i] - 2 * g * v) / (1 + g);
      next.u_m[i] = node.u_m[i] + dt_s_ * next.v_m_per_s[i];
    }
  }
}

void ScalarLattice::substep() {
  body_.dashpot_s > 0 ? stepAll<true>() : stepAll<false>();
  nodes_.swap(next_);
  kick_s_ = dt_s_;
}

std::vector<Vector3f> ScalarLattice::displacements() const {
  std::vector<Vector3f> out;
  for (uint32_t at : active_) out.emplace_back(nodes_[at].u_m[0], nodes_[at].u_m[1], nodes_[at].u_m[2]);
  return out;
}

}  // namespace viscera::bench
