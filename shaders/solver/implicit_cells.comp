// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// implicit_cells.comp - forces and majorisers of the cells in the current iterate, as volume.comp has them.
// Owner: solver/gpu/implicit_substep.h   physics.md 2
// in  displacement, increments [slots]     out  cell forces [3 * slots]
#include "layout.h"
#include "lattice.glsl"
#include "elastic.glsl"
#include "step.glsl"
#include "implicit.glsl"
#include "corners.glsl"

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
  vec4 pa = vec4(0.0f), pb = vec4(0.0f), pc = vec4(0.0f);
  if ((bits.lo & kCellBit) != 0u) {
    BodyParams body = bodies[bodyOf(bits)];
    float h = body.origin_spacing.w, bulk = cellBulk(slot, body);
    vec3 at[8], edge_lengths;
    for (uint c = 0u; c < 8u; ++c) {
      int corner = int(cornerSlot(slot, c));
      at[c] = xyz(texelFetch(displacement, corner)) + xyz(texelFetch(increment, corner));
    }
    CellShape s = shapeOf(at, h, edge_lengths);
    float p = volumePressure(bulk, s.e) * 0.25f / h;
    pa = vec4(p * s.bc, volumeMajoriser(bulk, s, edge_lengths, reach(h, iteration), h));
    pb = vec4(p * s.ca, 0.0f);
    pc = vec4(p * s.ab, 0.0f);
  }
  cell_forces_out[3u * slot] = pa;
  cell_forces_out[3u * slot + 1u] = pb;
  cell_forces_out[3u * slot + 2u] = pc;
}
