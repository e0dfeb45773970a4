// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// node_normal.comp - approximate normals of the nodes that the skin is bound to (VR05 eq 5).
// Owner: surface/surface.h   physics.md 4
// in  surface_nodes[count], displacement[slots] m, nodes[slots], stale_bricks[bricks]     out  node_normals[slots] xyz unit, w trust 0..1
#include "layout.h"
#ifndef __cplusplus
layout(local_size_x = GROUP_SIZE) in;  // before globalIndex(), which asks for it
#endif
#include "lattice.glsl"
#include "skin_basis.glsl"

#ifndef __cplusplus
uniform uint count;  // of surface nodes
uniform uint followed_revision;  // what moved no later is in place; 0: nothing is
layout(std430, binding = kBindStaleBricks) readonly buffer StaleBricksBuffer { uint stale_bricks[]; };
layout(std430, binding = kBindSurfaceNodes) readonly buffer SurfaceNodesBuffer { uint surface_nodes[]; };
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementBuffer { vec4 displacement[]; };
layout(std430, binding = kBindNodeNormals) writeonly buffer NodeNormalsBuffer { vec4 node_normals[]; };
#endif

void main() {
  uint index = globalIndex();
  if (index >= count) return;
  uint slot = surface_nodes[index];
  if (followed_revision != 0u && stale_bricks[slot >> 6] <= followed_revision) return;
  NodeBits bits = nodes[slot];
  float spacing = bodies[bricks[slot >> 6].body].origin_spacing.w;
  vec3 here = xyz(displacement[slot]);
  vec3 sum = vec3(0.0f);
#define ADD_AWAY_FROM_NEIGHBOR(SPRING, OFFSET)                                   \
  if (springCount(bits, SPRING) != 0u) {                                         \
    vec3 there = xyz(displacement[neighborSlot(slot, OFFSET)]);                   \
    sum -= direction(spacing * vec3(OFFSET) + (there - here), vec3(0.0f));        \
  }
  FOR_EACH_SPRING(ADD_AWAY_FROM_NEIGHBOR)
  // A cut takes neighbours away and would turn the normal towards the wound at once, so it is not trusted after one.
  bool severed = (bits.lo & kSeveredBit) != 0u;
  float clear = clamp((length(sum) - kNormalSumNone) / (kNormalSumFull - kNormalSumNone), 0.0f, 1.0f);
  node_normals[slot] = vec4(direction(sum, vec3(0.0f)), severed ? 0.0f : clear);
}
