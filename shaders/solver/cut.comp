// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// cut.comp - erase the springs that the swept blade crosses, from both ends.   Owner: solver/gpu/cut_pass.h   VR05 2.7.3
// in  displacement, tool motions     in/out  nodes (spring counts), stats.springs_cut
// Feature: PARTICLES erases every spring of the nodes near the blade instead (VR05's simple scheme).
//
// Each end decides for itself. That both come to the same verdict rests on this: the test sees the two ends in the order of
// their slots and every position comes from the same `precise` expression.
#include "layout.h"
#include "lattice.glsl"
#include "blade.glsl"

#ifndef __cplusplus
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementIn { vec4 displacement[]; };
layout(std140, binding = kBindToolMotions) uniform ToolMotionsBlock { ToolMotion tool_motions[kMaxStyluses]; };
layout(std430, binding = kBindStats) buffer StatsBuffer { TickStats stats; };

uniform uint active_count;
uniform uint stylus;
#endif
#include "surface_point.glsl"

/// The near end has been found not to be far; the far end must not be either, or the two ends would disagree.
bool severs(uint slot, vec3 x, uint other, ToolMotion m, vec4 sphere, float h) {
  vec3 y = seenFromBlade(other, m, h);
  if (farFromBlade(y, sphere)) return false;
#ifdef PARTICLES
  return erased(x, m) || erased(y, m);
#else
  return slot < other ? crossesBlade(x, y, m) : crossesBlade(y, x, m);
#endif
}

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  ToolMotion m = tool_motions[stylus];
#ifdef NETWORK
  if (bodies[bodyOf(bits)].connections != kImplicit) return;  // cut_links.comp has them
#endif
  float h = bodies[bodyOf(bits)].origin_spacing.w;
  vec3 x = seenFromBlade(slot, m, h);
  vec4 sphere = bladeSphere(m, h);
  if (isIsolated(bits) || farFromBlade(x, sphere)) return;
  NodeBits whole = bits;
  uint cut = 0u;
#define CUT_SPRING(spring, offset)                              \
  if (springCount(whole, spring) != 0u) {                       \
    uint n = neighborSlot(slot, offset);                        \
    if (severs(slot, x, n, m, sphere, h)) {                     \
      bits = withoutSpring(bits, spring);                       \
      cut += slot < n ? 1u : 0u;                                \
    }                                                           \
  }
  FOR_EACH_SPRING(CUT_SPRING)
  if (bits.lo == whole.lo && bits.hi == whole.hi) return;
  nodes[slot] = bits;
  if (cut != 0u) atomicAdd(stats.springs_cut, cut);
}
