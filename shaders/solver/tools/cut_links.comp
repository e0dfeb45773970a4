// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// cut_links.comp - erase the explicit connections that the swept blade crosses, from both ends.   Owner: solver/gpu/contact/cut_pass.h
// in  displacement, tool motions     in/out  links (stiffness), spring_cut, nodes (valence or counts), stats.springs_cut
// One invocation per spring, so the two ends cannot disagree. No node is lost, and no mass. The tissue points of a spring's ends
// decide whether it is cut; the line between its nodes, which surface meshes and walls follow, decides where.
// Feature: PARTICLES erases the springs of the nodes near the blade instead.
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tools/blade.glsl"

#ifndef __cplusplus
layout(std430, binding = kBindSprings) readonly buffer SpringsBuffer { SpringEnds springs[]; };
layout(std430, binding = kBindLinks) buffer LinksBuffer { Link links[]; };
layout(std430, binding = kBindSpringCut) buffer SpringCutBuffer { float spring_cut[]; };
layout(std430, binding = kBindNodes) buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementIn { vec4 displacement[]; };
layout(std430, binding = kBindVelocityIn) readonly buffer VelocityIn { vec4 velocity[]; };
layout(std140, binding = kBindToolMotions) uniform ToolMotionsBlock { ToolMotion tool_motions[kMaxStyluses]; };
layout(std430, binding = kBindStats) buffer StatsBuffer { TickStats stats; };

uniform uint spring_count;
uniform uint stylus;
uniform uint spared;  // bodies that are not cut, one bit each
#endif
#include "solver/tissue/surface_point.glsl"

/// Removes one link from a node: from its valence, or from a lattice's counts.
void loseLink(uint slot, uint lattice_spring) {
  if (bodies[bodyOf(nodes[slot])].connections == kNetwork) {
    atomicAdd(nodes[slot].lo, 0xffffffffu);
  } else if (lattice_spring < kAxialSprings) {
    atomicAnd(nodes[slot].lo, ~(7u << (3u * lattice_spring)));
  } else if (lattice_spring < kSpringsPerNode) {
    atomicAnd(nodes[slot].hi, ~(3u << (2u * (lattice_spring - kAxialSprings))));
  }
  atomicOr(nodes[slot].lo, kSeveredBit);
}

void main() {
  uint i = globalIndex();
  if (i >= spring_count || spring_cut[i] != 0.0f) return;
  SpringEnds ends = springs[i];
  ToolMotion m = tool_motions[stylus];
  uint body = bodyOf(nodes[ends.a]);
#ifndef __cplusplus
  if (((spared >> body) & 1u) != 0u) return;
#endif
  float h = bodies[body].origin_spacing.w;
  vec3 x = seenFromBlade(ends.a, m, h), y = seenFromBlade(ends.b, m, h);
#ifdef PARTICLES
  if (!erased(x, m) && !erased(y, m)) return;
  float share = kErasedShare;
#else
  vec3 offset = startOffset(m, (0.5f * m.timing.x) * (xyz(velocity[ends.a]) + xyz(velocity[ends.b])));
  ToolMotion seen = startingAt(m, offset);
  uint part = crossedPart(x - offset, y - offset, seen);
  if (part == 0u) return;
  float share = shareBefore(nodeFromBlade(ends.a, m) - offset, nodeFromBlade(ends.b, m) - offset, part, seen);
#endif
  spring_cut[i] = share;
  links[ends.link_a].stiffness = 0.0f;
  links[ends.link_b].stiffness = 0.0f;
  loseLink(ends.a, links[ends.link_a].lattice_spring & kLatticeSpringMask);
  loseLink(ends.b, links[ends.link_b].lattice_spring & kLatticeSpringMask);
  atomicAdd(stats.springs_cut, 1u);
}
