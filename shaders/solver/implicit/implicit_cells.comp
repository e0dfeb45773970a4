// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// implicit_cells.comp - forces and majorisers of the cells in the current iterate, as volume.comp has them.
// Owner: solver/device/implicit_substep.h   physics.md 2
// in  displacement, increments [slots]     out  cell forces [cell_vectors * slots]
#ifndef __cplusplus
#define MAKES_CELL_FORCES
#endif
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/implicit/implicit.glsl"
#include "solver/tissue/corners.glsl"

#ifndef __cplusplus
layout(std430, binding = kBindCells) readonly buffer CellsBuffer { uint cells[]; };
layout(std430, binding = kBindCellForces) writeonly buffer CellForcesBuffer { vec4 cell_forces_out[]; };
uniform uint iteration;
#endif

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;  // of cells
  uint slot = cells[i];
  NodeBits bits = nodes[slot];
  CellForces f = {vec3(0.0f), vec3(0.0f), vec3(0.0f), vec3(0.0f), vec3(0.0f), vec3(0.0f), vec3(0.0f)};
  float majoriser = 0.0f;
  if ((bits.lo & kCellBit) != 0u) {
    BodyParams body = bodies[bodyOf(bits)];
    float h = body.origin_spacing.w, bulk = cellBulk(slot, body);
    vec3 at[8], edge_lengths;
    for (uint c = 0u; c < 8u; ++c) {
      int corner = int(cornerSlot(slot, c));
      at[c] = xyz(stateAt(displacement, corner)) + xyz(stateAt(increment, corner));
    }
    CellShape s = shapeOf(at, h, edge_lengths);
    float rigidity = cellRigidity(slot, body);
    majoriser = volumeMajoriser(bulk, s, edge_lengths, reach(h, iteration), h);
    if (rigidity > 0.0f) majoriser += crushedMajoriser(cellMotion(at, h), rigidity, reach(h, iteration), h);
    f = cellForces(at, s, volumePressure(bulk, s.e) * 0.25f / h, h, bulk, rigidity, cellMoments(slot));
  }
  LEAVE_CELL_FORCES(slot, f, majoriser)
}
