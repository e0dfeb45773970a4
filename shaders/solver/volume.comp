// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// volume.comp - forces of every cell's energy of volume.   Owner: solver/gpu/volume_pass.h   physics.md 1
// in  displacement, nodes     out  cell forces [3 * slots]
// Per cell three vectors p/(4h) (b x c, c x a, a x b): corner (sx, sy, sz) of the cell feels minus their sum, signed. (implicit_cells.comp
// writes the same for its iterates, with a majoriser in w of the first.) Feature CUT drops the cells that lost a spring instead.
#include "layout.h"
#include "lattice.glsl"
#include "elastic.glsl"
#include "corners.glsl"

#ifndef __cplusplus
layout(std430, binding = kBindCells) readonly buffer CellsBuffer { uint cells[]; };
uniform uint cell_count;
#endif

#ifdef CUT
#ifndef __cplusplus
layout(std430, binding = kBindNodes) buffer NodesBuffer { NodeBits nodes[]; };
#endif

/// Has one of the cell's 24 springs, seen from a corner, been cut?
bool torn(uint slot, uint c) {
  NodeBits bits = nodes[cornerSlot(slot, c)];
  if ((bits.lo & kSeveredBit) == 0u) return false;
  ivec3 at = ivec3(c & 1u, (c >> 1) & 1u, (c >> 2) & 1u);
  bool lost = false;
#define LOST(spring, offset)                                                                        \
  {                                                                                                 \
    ivec3 to = at + offset;                                                                         \
    lost = lost || (all(greaterThanEqual(to, ivec3(0))) && all(lessThanEqual(to, ivec3(1))) && springCount(bits, spring) == 0u); \
  }
  FOR_EACH_SPRING(LOST)
  return lost;
}

void main() {
  uint i = globalIndex();
  if (i >= cell_count) return;
  uint slot = cells[i];
  if ((nodes[slot].lo & kCellBit) == 0u) return;
  bool lost = false;
  for (uint c = 0u; c < 8u; ++c) lost = lost || torn(slot, c);
  if (lost) nodes[slot].lo &= ~kCellBit;
}
#else
#ifndef __cplusplus
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindCellForces) writeonly buffer CellForcesBuffer { vec4 cell_forces_out[]; };
#endif

vec3 u(uint slot) { return xyz(texelFetch(displacement, int(slot))); }

void main() {
  uint i = globalIndex();
  if (i >= cell_count) return;
  uint slot = cells[i];
  NodeBits bits = nodes[slot];
  vec4 pa = vec4(0.0f), pb = vec4(0.0f), pc = vec4(0.0f);
  if ((bits.lo & kCellBit) != 0u) {
    BodyParams body = bodies[bodyOf(bits)];
    float h = body.origin_spacing.w, bulk = cellBulk(slot, body);
    vec3 n0 = u(slot), n1 = u(cornerSlot(slot, 1u)), n2 = u(cornerSlot(slot, 2u)), n3 = u(cornerSlot(slot, 3u));
    vec3 n4 = u(cornerSlot(slot, 4u)), n5 = u(cornerSlot(slot, 5u)), n6 = u(cornerSlot(slot, 6u)), n7 = u(cornerSlot(slot, 7u));
    float quarter = 0.25f / h;
    vec3 da = quarter * ((n1 - n0) + (n3 - n2) + (n5 - n4) + (n7 - n6));
    vec3 db = quarter * ((n2 - n0) + (n3 - n1) + (n6 - n4) + (n7 - n5));
    vec3 dc = quarter * ((n4 - n0) + (n5 - n1) + (n6 - n2) + (n7 - n3));
    CellShape s = cellShape(da, db, dc);
    float p = volumePressure(bulk, s.e) * quarter;
    pa = vec4(p * s.bc, 0.0f);
    pb = vec4(p * s.ca, 0.0f);
    pc = vec4(p * s.ab, 0.0f);
  }
  cell_forces_out[3u * slot] = pa;
  cell_forces_out[3u * slot + 1u] = pb;
  cell_forces_out[3u * slot + 2u] = pc;
}
#endif
