// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/solver.h"

#include <cmath>
#include <limits>

#include "viscera/math/state_hash.h"

namespace viscera {

layout::BodyParams bodyParams(const Body& body, double dt_safe_s) {
  const double h = body.lattice.spacing_m;
  const double stiffness = 0.4 * body.material.young_modulus_pa * h;  // physics.md 1: E = 2.5 k/h at nu = 1/4
  const double cell_mass = body.material.density_kg_per_m3 * h * h * h;
  layout::BodyParams params{};
  params.origin_spacing = {static_cast<float>(body.lattice.origin_m.x()), static_cast<float>(body.lattice.origin_m.y()),
                           static_cast<float>(body.lattice.origin_m.z()), static_cast<float>(h)};
  params.axial_quarter_n_per_m = static_cast<float>(stiffness / 4);
  params.diagonal_half_n_per_m = static_cast<float>(stiffness / 2);
  params.mass_eighth_kg = static_cast<float>(cell_mass / 8);
  params.drag_per_s = static_cast<float>(body.material.drag_per_s);
  // c = 2 xi k / omega_max with omega_max = 2 / dt_safe (physics.md 2).
  params.dashpot_s = static_cast<float>(body.material.dashpot_ratio * dt_safe_s);
  return params;
}

double safeTimeStep(const Model& model) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Body& body : model.bodies) {
    const layout::BodyParams params = bodyParams(body, 0);
    for (uint32_t slot : body.lattice.active_slots) {
      const layout::NodeBits& bits = body.lattice.nodes[slot];
      double stiffness = 0;
      for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
        stiffness += springCount(bits, s) *
                     static_cast<double>(isAxial(s) ? params.axial_quarter_n_per_m : params.diagonal_half_n_per_m);
      }
      if (isFixed(bits) || stiffness == 0) continue;
      smallest = std::min(smallest, std::sqrt(2.0 * massEighths(bits) * params.mass_eighth_kg / stiffness));
    }
  }
  return smallest;
}

uint64_t stateHash(const Model& model, const HostState& state) {
  StateHash hash;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (uint32_t local : model.bodies[b].lattice.active_slots) {
      const uint32_t slot = model.slotOffset(b) + local;
      for (const layout::vec4& v : {state.displacement_m[slot], state.velocity_m_per_s[slot]}) {
        hash.add(v.x);
        hash.add(v.y);
        hash.add(v.z);
      }
      hash.add(state.nodes[slot].lo & layout::kAxialMask);
      hash.add(state.nodes[slot].hi & layout::kDiagonalMask);
    }
  }
  return hash.value();
}

}  // namespace viscera
