// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Position of a node's tissue: at the node or, where cells are partially filled and it is outside them, at the nearest point of
// the surface (physics.md 5). After lattice.glsl.
// Features: LAW and PARTS together: some cells may be partially filled.

#ifndef __cplusplus
#if defined(LAW) && defined(PARTS)
layout(std430, binding = kBindSurfaceOffsets) readonly buffer SurfaceOffsetsBuffer { uint surface_offsets[]; };
uint surfaceOffset(uint slot) { return surface_offsets[slot]; }
#else
uint surfaceOffset(uint slot) { return 0u; }
#endif
#endif

float offsetComponent(uint offset, uint axis) {
  return kOffsetStep * float(int((offset >> (kOffsetBits * axis)) & ((1u << kOffsetBits) - 1u)) - kOffsetZero);
}

/// Returns the displacement from a node to the surface at rest, in cells. @param way  not 0
vec3 offsetInCells(uint offset) { return vec3(offsetComponent(offset, 0u), offsetComponent(offset, 1u), offsetComponent(offset, 2u)); }

/// Returns the other end of the edge along an axis, towards the surface; the node itself if there is none.
uint pathEnd(uint slot, uint offset, uint axis) {
  float cells = offsetComponent(offset, axis);
  if (cells == 0.0f || (offset & (kOffsetEdgeBit << axis)) == 0u) return slot;
  int side = cells > 0.0f ? 1 : -1;
  return neighborSlot(slot, ivec3(axis == 0u ? side : 0, axis == 1u ? side : 0, axis == 2u ? side : 0));
}

/// Returns the displacement, relative to the node, of a point `cells` along an edge from it.
vec3 alongEdge(float cells, vec3 u, vec3 u_end, float h) {
  vec3 change = u_end - u;
  // Whether edges were cut is not read, as the other end may be about to write it: an end that is far away has been cut off.
  return dot(change, change) < h * h ? abs(cells) * change : vec3(0.0f);
}

/// Returns the displacement from a node to its tissue [m], given the displacements of the node and of its pathEnd()s along x, y
/// and z. @param way  not 0
vec3 toTissueIn(uint offset, float h, vec3 u, vec3 u_x, vec3 u_y, vec3 u_z) {
  vec3 cells = offsetInCells(offset);
  precise vec3 moved = alongEdge(cells.x, u, u_x, h) + alongEdge(cells.y, u, u_y, h);
  precise vec3 turned = moved + alongEdge(cells.z, u, u_z, h);
  precise vec3 out_m = h * cells + turned;
  return out_m;
}
