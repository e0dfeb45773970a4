// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "export/cell_stress.h"
#include "math/vec4.h"
#include "viscera/model/model.h"
#include "viscera/solver/solver.h"

namespace viscera {

/// An uncut cell of a body's lattice.
struct UncutCell {
  uint32_t lowest;
  std::array<uint32_t, 8> corners;  ///< slots of the body, x first
  std::array<Vector3d, 8> u_m;      ///< displacements of the corners
  CellStress stress;
};

/// Calls visit(cell) for the uncut cells of a body. @param body  with cells   @param offset  of its slots in the state
template <class Visit>
void forUncutCells(const Body& body, const CellStresses& stresses, uint32_t offset, const HostState& state,
                   const Visit& visit) {
  for (const uint32_t slot : body.lattice.active_slots) {
    if (!(state.nodes[offset + slot].lo & layout::kCellBit)) continue;
    UncutCell cell{slot, {}, {}, {}};
    const Vector3i at = body.lattice.nodeAt(slot);
    for (uint32_t c = 0; c < 8; ++c) {
      const Vector3i step(static_cast<int>(c & 1), static_cast<int>(c >> 1 & 1), static_cast<int>(c >> 2 & 1));
      cell.corners[c] = static_cast<uint32_t>(body.lattice.slotAt(at + step));
      cell.u_m[c] = xyz(state.displacement_m[offset + cell.corners[c]]);
    }
    cell.stress = stresses.at(slot, cell.u_m);
    visit(cell);
  }
}

/// Calls visit(body, spring, step_m) for the springs of networks that are not cut. `step_m` runs from end a to end b.
template <class Visit>
void forUncutSprings(const Model& model, const HostState& state, const Visit& visit) {
  size_t index = 0;  // of springs over all bodies
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (!body.network) continue;
    const uint32_t offset = model.slotOffset(b);
    for (const NetworkSpring& spring : body.network->springs) {
      if (state.spring_cut[index++] != 0) continue;
      const Vector3d step_m = restPosition(body, spring.b) + xyz(state.displacement_m[offset + spring.b]) -
                              restPosition(body, spring.a) - xyz(state.displacement_m[offset + spring.a]);
      visit(b, spring, step_m);
    }
  }
}

}  // namespace viscera
