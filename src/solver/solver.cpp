// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/solver.h"

#include "viscera/math/state_hash.h"

namespace viscera {

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
