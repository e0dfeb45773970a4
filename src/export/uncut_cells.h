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

}  // namespace viscera
