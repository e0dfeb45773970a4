// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// cut.comp - erase the springs that the swept blade crosses, from both ends.   Owner: solver/gpu/contact/cut_pass.h   VR05 2.7.3
// in  displacement, velocity, tool motions     in/out  nodes (spring counts), stats.springs_cut; RECORD: axial_cut[3 * slots], cut_sides[slots]
// Features: PARTICLES erases every spring of the nodes near the blade instead (VR05's simple scheme). RECORD: records where axial
// springs were cut, and on which side of the cut nodes are. The tissue points of a spring's ends decide whether it is cut, the
// line between its nodes where.
//
// Each end decides for itself. Both reach the same decision because the test is called at one place, with the two ends in the
// order of their slots, and every position and displacement comes from the same `precise` expression.
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tools/blade.glsl"

#ifndef __cplusplus
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementIn { vec4 displacement[]; };
#ifndef PARTICLES
layout(std430, binding = kBindVelocityIn) readonly buffer VelocityIn { vec4 velocity[]; };
#endif
layout(std140, binding = kBindToolMotions) uniform ToolMotionsBlock { ToolMotion tool_motions[kMaxStyluses]; };
layout(std430, binding = kBindStats) buffer StatsBuffer { TickStats stats; };
#ifdef RECORD
layout(std430, binding = kBindAxialCut) writeonly buffer AxialCutBuffer { float axial_cut[]; };
#endif

uniform uint active_count;
uniform uint stylus;
uniform uint spared;  // bodies that are not cut, one bit each
bool mayCross(uint slot, uint other) { return true; }  // in C++ it tests the box around the sweep
#endif
#include "solver/tissue/surface_point.glsl"
#if defined(RECORD) && !defined(PARTICLES)
#include "solver/tools/cut_sides.glsl"
#else
vec3 onItsSide(uint slot, vec3 x, ToolMotion m, float h) { return x; }
void rememberSide(uint slot, vec3 x, ToolMotion m) {}
#endif

#ifndef PARTICLES
vec3 moveOf(uint first, uint second, ToolMotion m) {
  precise vec3 move = (0.5f * m.timing.x) * (xyz(velocity[first]) + xyz(velocity[second]));
  return startOffsetAlong(m, move);
}

/// Returns the triangle of the sweep that a segment between two nodes crosses, given its motion in the last substep; 0: none.
/// @param first, second  the nodes, in the order of their slots   @param a, b  the ends
uint crossedInStep(uint first, uint second, vec3 a, vec3 b, ToolMotion m) {
  vec3 offset = moveOf(first, second, m);
  precise vec3 from = a - offset;
  precise vec3 to = b - offset;
  return crossedPart(from, to, startingAt(m, offset));
}
#endif

/// Returns the triangle of the sweep that severs a spring; 0: none. The near end was found not to be far; the far end must not be
/// either, or the two ends would disagree.
/// @param x  position of `slot`, on its side
uint severingPart(uint slot, vec3 x, uint other, ToolMotion m, vec4 sphere, float h) {
  vec3 y = seenFromBlade(other, m, h);
  if (farFromBlade(y, sphere)) return 0u;
  y = onItsSide(other, y, m, h);
#ifdef PARTICLES
  return erased(x, m) || erased(y, m) ? 1u : 0u;
#else
  bool first = slot < other;  // chosen before the single call: if compiled twice, the test might be rounded in two ways
  return crossedInStep(first ? slot : other, first ? other : slot, first ? x : y, first ? y : x, m);
#endif
}

#ifdef RECORD
/// Records where a spring was cut, at the node from which it points along +x, +y or +z. A spring is cut once, so the first cut
/// stays.
void record(uint slot, uint spring, uint other, uint part, ToolMotion m) {
  if (spring >= kAxialSprings || (spring & 1u) != 0u) return;
#ifdef PARTICLES
  axial_cut[3u * slot + (spring >> 1)] = kErasedShare;
#else
  vec3 offset = moveOf(min(slot, other), max(slot, other), m);
  axial_cut[3u * slot + (spring >> 1)] =
      shareBefore(nodeFromBlade(slot, m) - offset, nodeFromBlade(other, m) - offset, part, startingAt(m, offset));
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
  if (bodies[bodyOf(bits)].connections != kImplicit) return;  // handled by cut_links.comp
#endif
#ifndef __cplusplus  // in C++ the caller selects bodies
  if (((spared >> bodyOf(bits)) & 1u) != 0u) return;
#endif
  float h = bodies[bodyOf(bits)].origin_spacing.w;
  vec4 sphere = bladeSphere(m, h);
#ifndef __cplusplus  // in C++ the caller passes near nodes only; the tissue point of a far node is not needed
  if (farFromBlade(nodeFromBlade(slot, m), vec4(xyz(sphere), sphere.w + kFarthestTissue * h))) return;
#endif
  vec3 x = seenFromBlade(slot, m, h);
  if (isIsolated(bits) || farFromBlade(x, sphere)) return;
  vec3 own = onItsSide(slot, x, m, h);
  NodeBits whole = bits;
  uint cut = 0u;
#define CUT_SPRING(spring, offset)                              \
  if (springCount(whole, spring) != 0u) {                       \
    uint n = neighborSlot(slot, offset);                        \
    uint part = mayCross(slot, n) ? severingPart(slot, own, n, m, sphere, h) : 0u; \
    if (part != 0u) {                                           \
      bits = withoutSpring(bits, spring);                       \
      record(slot, spring, n, part, m);                         \
      cut += slot < n ? 1u : 0u;                                \
    }                                                           \
  }
  FOR_EACH_SPRING(CUT_SPRING)
  if (bits.lo == whole.lo && bits.hi == whole.hi) return;
  nodes[slot] = bits;
  rememberSide(slot, x, m);
  if (cut != 0u) atomicAdd(stats.springs_cut, cut);
}
