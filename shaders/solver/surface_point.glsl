// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the tissue of a node is: at the node, or, where cells are tissue in part and it lies outside of them, at the nearest
// point of the surface (physics.md 5). After lattice.glsl; reads displacement[].
// Features: MOMENTS and PARTS together: some cells may be tissue in part.

#ifndef __cplusplus
#if defined(MOMENTS) && defined(PARTS)
layout(std430, binding = kBindSurfaceWays) readonly buffer SurfaceWaysBuffer { uint surface_ways[]; };
uint surfaceWay(uint slot) { return surface_ways[slot]; }
#else
uint surfaceWay(uint slot) { return 0u; }
#endif
#endif

float wayComponent(uint way, uint axis) {
  return kWayStep * float(int((way >> (kWayBits * axis)) & ((1u << kWayBits) - 1u)) - kWayZero);
}

/// How much farther than its node a point moves that lies `cells` along an axis from it, by the edge there.
vec3 alongEdge(uint slot, uint way, uint axis, float cells, vec3 u, float h) {
  if (cells == 0.0f || (way & (kWayEdgeBit << axis)) == 0u) return vec3(0.0f);
  int side = cells > 0.0f ? 1 : -1;
  vec3 change = xyz(displacement[neighborSlot(slot, ivec3(axis == 0u ? side : 0, axis == 1u ? side : 0, axis == 2u ? side : 0))]) - u;
  // Edges are not asked whether they were cut, as the other end may be about to write it: what is far has been.
  return dot(change, change) < h * h ? abs(cells) * change : vec3(0.0f);
}

/// From a node to its tissue in the state at hand [m].
vec3 toTissue(uint slot, float h) {
  uint way = surfaceWay(slot);
  if (way == 0u) return vec3(0.0f);
  vec3 cells = vec3(wayComponent(way, 0u), wayComponent(way, 1u), wayComponent(way, 2u)), u = xyz(displacement[slot]);
  precise vec3 moved = alongEdge(slot, way, 0u, cells.x, u, h) + alongEdge(slot, way, 1u, cells.y, u, h);
  precise vec3 turned = moved + alongEdge(slot, way, 2u, cells.z, u, h);
  precise vec3 out_m = h * cells + turned;
  return out_m;
}

/// Position of a node's tissue relative to the blade's first tip [m]: a blade in the air cuts nothing, one that ends there
/// spares nothing.
vec3 seenFromBlade(uint slot, ToolMotion m, float h) {
  precise vec3 x = (restPosition(slot) - xyz(m.from)) + xyz(displacement[slot]);
  precise vec3 tissue = x + toTissue(slot, h);
  return tissue;
}
