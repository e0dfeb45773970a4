// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// node_normal.comp - approximate normals of the nodes that surface meshes are bound to: at rest those of VR05 eq 5, in
// motion turned with the tissue, by the gradient from a node's axial neighbours. With SUMMED eq 5 in motion too, as in
// the paper: pure stretch turns that one where neighbours are not the same on all sides (surface.md).
// Owner: surface/surface.h   physics.md 4
// in  surface_nodes[count], displacement[slots] m, nodes[slots], stale_bricks[bricks]
// out  node_normals[slots] xyz unit, w trust 0..1
#include "layout.h"
#ifndef __cplusplus
layout(local_size_x = GROUP_SIZE) in;  // globalIndex() needs it
#endif
#include "solver/tissue/lattice.glsl"
#include "skin_basis.glsl"

#ifndef __cplusplus
uniform uint first_item, count;  // of surface nodes
uniform uint followed_revision;  // nodes that have not moved after it are up to date; 0: none are
layout(std430, binding = kBindStaleBricks) readonly buffer StaleBricksBuffer { uint stale_bricks[]; };
layout(std430, binding = kBindSurfaceNodes) readonly buffer SurfaceNodesBuffer { SurfaceNode surface_nodes[]; };
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementBuffer { vec4 displacement[]; };
layout(std430, binding = kBindNodeNormals) writeonly buffer NodeNormalsBuffer { vec4 node_normals[]; };
#endif

#ifndef SUMMED
/// Returns the derivative of displacement along an axis, times the spacing, from the neighbours that exist. A node that
/// was not cut has at least one.
vec3 slopeAlong(uint slot, NodeBits bits, uint spring, ivec3 offset, vec3 here) {
  bool ahead = springCount(bits, spring) != 0u, behind = springCount(bits, spring + 1u) != 0u;
  vec3 from = behind ? xyz(displacement[neighborSlot(slot, -offset)]) : here;
  vec3 to = ahead ? xyz(displacement[neighborSlot(slot, offset)]) : here;
  return ahead && behind ? 0.5f * (to - from) : to - from;
}
#endif

void main() {
  if (globalIndex() >= count) return;
  SurfaceNode node = surface_nodes[first_item + globalIndex()];
  uint slot = node.slot;
  if (followed_revision != 0u && stale_bricks[slot >> 6] <= followed_revision) return;
  NodeBits bits = nodes[slot];
  // A cut removes neighbours, which turns the normal towards the wound at once, so it is not trusted after one.
  bool severed = (bits.lo & kSeveredBit) != 0u;
  float spacing = bodies[bricks[slot >> 6].body].origin_spacing.w;
  vec3 here = xyz(displacement[slot]);
#ifdef SUMMED
  vec3 sum = vec3(0.0f);
#define ADD_AWAY_FROM_NEIGHBOR(SPRING, OFFSET)                                   \
  if (springCount(bits, SPRING) != 0u) {                                         \
    vec3 there = xyz(displacement[neighborSlot(slot, OFFSET)]);                   \
    sum -= direction(spacing * vec3(OFFSET) + (there - here), vec3(0.0f));        \
  }
  FOR_EACH_SPRING(ADD_AWAY_FROM_NEIGHBOR)
  float clear = clamp((length(sum) - kNormalSumNone) / (kNormalSumFull - kNormalSumNone), 0.0f, 1.0f);
#else
  vec3 a = vec3(spacing, 0.0f, 0.0f) + slopeAlong(slot, bits, 0u, ivec3(1, 0, 0), here);
  vec3 b = vec3(0.0f, spacing, 0.0f) + slopeAlong(slot, bits, 2u, ivec3(0, 1, 0), here);
  vec3 c = vec3(0.0f, 0.0f, spacing) + slopeAlong(slot, bits, 4u, ivec3(0, 0, 1), here);
  vec3 sizes = abs(a) + abs(b) + abs(c);
  float size = (sizes.x + sizes.y) + sizes.z;
  vec3 sum = vec3(0.0f);
  if (size > kShortest && size < kLongest) {  // so that products neither underflow nor overflow
    a /= size;
    b /= size;
    c /= size;
    // Stretch turns a plane's normal one way and a fibre along it the opposite way: their sum turns with the tissue.
    sum = direction(node.normal_x * cross(b, c) + node.normal_y * cross(c, a) + node.normal_z * cross(a, b), vec3(0.0f)) +
          direction(node.normal_x * a + node.normal_y * b + node.normal_z * c, vec3(0.0f));
  }
  float clear = 1.0f;  // at rest, or no vertex would follow it
#endif
  node_normals[slot] = vec4(direction(sum, vec3(0.0f)), severed ? 0.0f : clear);
}
