// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// cut.comp - erase the springs that the swept blade crosses, from both ends.   Owner: solver/gpu/cut_pass.h   VR05 2.7.3
// in  displacement, tool motions     in/out  nodes (spring counts), stats.springs_cut; RECORD: axial_cut[3 * slots]
// Features: PARTICLES erases every spring of the nodes near the blade instead (VR05's simple scheme). RECORD: axial springs
// remember where they were cut. Whether a spring is, its ends' tissue decides; where, the line between its nodes says.
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
#ifdef RECORD
layout(std430, binding = kBindAxialCut) writeonly buffer AxialCutBuffer { float axial_cut[]; };
#endif

uniform uint active_count;
uniform uint stylus;
#endif
#include "surface_point.glsl"

/// Which part of the sweep severs a spring; 0 where none does. The near end has been found not to be far; the far end must not
/// be either, or the two ends would disagree.
uint severingPart(uint slot, vec3 x, uint other, ToolMotion m, vec4 sphere, float h) {
  vec3 y = seenFromBlade(other, m, h);
  if (farFromBlade(y, sphere)) return 0u;
#ifdef PARTICLES
  return erased(x, m) || erased(y, m) ? 1u : 0u;
#else
  return slot < other ? crossedPart(x, y, m) : crossedPart(y, x, m);
#endif
}

#ifdef RECORD
/// Notes where a spring was cut, at the node from which it leads along +x, +y or +z. A spring is cut once, so the first cut stays.
void record(uint slot, uint spring, uint other, uint part, ToolMotion m) {
  if (spring >= kAxialSprings || (spring & 1u) != 0u) return;
#ifdef PARTICLES
  axial_cut[3u * slot + (spring >> 1)] = kErasedShare;
#else
  axial_cut[3u * slot + (spring >> 1)] = shareBefore(nodeFromBlade(slot, m), nodeFromBlade(other, m), part, m);
#endif
}
#else
void record(uint slot, uint spring, uint other, uint part, ToolMotion m) {}
#endif

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
    uint part = severingPart(slot, x, n, m, sphere, h);         \
    if (part != 0u) {                                           \
      bits = withoutSpring(bits, spring);                       \
      record(slot, spring, n, part, m);                         \
      cut += slot < n ? 1u : 0u;                                \
    }                                                           \
  }
  FOR_EACH_SPRING(CUT_SPRING)
  if (bits.lo == whole.lo && bits.hi == whole.hi) return;
  nodes[slot] = bits;
  if (cut != 0u) atomicAdd(stats.springs_cut, cut);
}
