// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the tissue of a node is: at the node, or, where cells are tissue in part and it lies outside of them, at the nearest
// point of the surface (physics.md 5). After lattice.glsl.
// Features: LAW and PARTS together: some cells may be tissue in part.

#ifndef __cplusplus
#if defined(LAW) && defined(PARTS)
layout(std430, binding = kBindSurfaceWays) readonly buffer SurfaceWaysBuffer { uint surface_ways[]; };
uint surfaceWay(uint slot) { return surface_ways[slot]; }
#else
uint surfaceWay(uint slot) { return 0u; }
#endif
#endif

float wayComponent(uint way, uint axis) {
  return kWayStep * float(int((way >> (kWayBits * axis)) & ((1u << kWayBits) - 1u)) - kWayZero);
}

/// From a node to the surface at rest, in cells. @param way  not 0
vec3 wayInCells(uint way) { return vec3(wayComponent(way, 0u), wayComponent(way, 1u), wayComponent(way, 2u)); }

/// The other end of the edge along an axis, to the side of the way; the node itself where none is.
uint wayEnd(uint slot, uint way, uint axis) {
  float cells = wayComponent(way, axis);
  if (cells == 0.0f || (way & (kWayEdgeBit << axis)) == 0u) return slot;
  int side = cells > 0.0f ? 1 : -1;
  return neighborSlot(slot, ivec3(axis == 0u ? side : 0, axis == 1u ? side : 0, axis == 2u ? side : 0));
}

/// How much farther than its node a point moves that lies `cells` along an edge from it.
vec3 alongEdge(float cells, vec3 u, vec3 u_end, float h) {
  vec3 change = u_end - u;
  // Edges are not asked whether they were cut, as the other end may be about to write it: what is far has been.
  return dot(change, change) < h * h ? abs(cells) * change : vec3(0.0f);
}

/// From a node to its tissue [m], in a state in which it and its wayEnd()s along x, y and z are displaced so. @param way  not 0
vec3 toTissueIn(uint way, float h, vec3 u, vec3 u_x, vec3 u_y, vec3 u_z) {
  vec3 cells = wayInCells(way);
  precise vec3 moved = alongEdge(cells.x, u, u_x, h) + alongEdge(cells.y, u, u_y, h);
  precise vec3 turned = moved + alongEdge(cells.z, u, u_z, h);
  precise vec3 out_m = h * cells + turned;
  return out_m;
}
