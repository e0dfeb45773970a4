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

layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementIn { vec4 displacement[]; };
layout(std140, binding = kBindToolMotions) uniform ToolMotionsBlock { ToolMotion tool_motions[kMaxStyluses]; };
layout(std430, binding = kBindStats) buffer StatsBuffer { TickStats stats; };

layout(location = 0) uniform uint active_count;
layout(location = 1) uniform uint stylus;

const float kLongest = 8.0;  // rest lengths of a diagonal: a spring with an end farther from the blade is not cut

/// Position relative to the blade's first tip [m].
vec3 seenFromBlade(uint slot, ToolMotion m) {
  precise vec3 x = (restPosition(slot) - m.from.xyz) + displacement[slot].xyz;
  return x;
}

/// Six times the signed volume of the tetrahedron (o, a, b, c) with o at the origin of the vectors.
float triple(vec3 a, vec3 b, vec3 c) {
  precise float v = dot(cross(a, b), c);
  return v;
}

/// Does the segment a..b cross the triangle p q r? One end belongs to a side, so no end lies between; edges belong to it.
bool crossesTriangle(vec3 a, vec3 b, vec3 p, vec3 q, vec3 r) {
  vec3 normal = cross(q - p, r - p);
  if (dot(normal, normal) == 0.0) return false;  // the blade did not move
  if ((dot(a - p, normal) >= 0.0) == (dot(b - p, normal) >= 0.0)) return false;
  vec3 ab = b - a;
  float pq = triple(p - a, q - a, ab), qr = triple(q - a, r - a, ab), rp = triple(r - a, p - a, ab);
  return (pq >= 0.0 && qr >= 0.0 && rp >= 0.0) || (pq <= 0.0 && qr <= 0.0 && rp <= 0.0);
}

/// The blade sweeps a quadrilateral: tip and far end at the start, far end and tip at the end.
bool crossesBlade(vec3 a, vec3 b, ToolMotion m) {
  vec3 tip = m.to.xyz - m.from.xyz, far_from = m.blade_from.xyz - m.from.xyz, far_to = m.blade_to.xyz - m.from.xyz;
  return crossesTriangle(a, b, vec3(0.0), far_from, far_to) || crossesTriangle(a, b, vec3(0.0), far_to, tip);
}

float segmentDistance(vec3 a, vec3 b, vec3 x) {
  vec3 ab = b - a;
  float length2 = dot(ab, ab);
  return distance(x, length2 > 0.0 ? a + clamp(dot(x - a, ab) / length2, 0.0, 1.0) * ab : a);
}

float planeDistanceInside(vec3 p, vec3 q, vec3 r, vec3 x, float otherwise) {
  vec3 normal = cross(q - p, r - p);
  float area2 = dot(normal, normal);
  if (area2 == 0.0) return otherwise;
  bool inside = dot(cross(q - p, x - p), normal) >= 0.0 && dot(cross(r - q, x - q), normal) >= 0.0 &&
                dot(cross(p - r, x - r), normal) >= 0.0;
  return inside ? min(otherwise, abs(dot(x - p, normal)) / sqrt(area2)) : otherwise;
}

/// Is a node within the eraser's radius of the swept blade?
bool erased(vec3 x, ToolMotion m) {
  vec3 tip = m.to.xyz - m.from.xyz, far_from = m.blade_from.xyz - m.from.xyz, far_to = m.blade_to.xyz - m.from.xyz;
  precise float d = min(min(segmentDistance(vec3(0.0), far_from, x), segmentDistance(tip, far_to, x)),
                        min(segmentDistance(vec3(0.0), tip, x), segmentDistance(far_from, far_to, x)));
  d = planeDistanceInside(vec3(0.0), far_from, far_to, x, d);
  d = planeDistanceInside(vec3(0.0), far_to, tip, x, d);
  return d <= m.blade_from.w;
}

/// Bounding sphere of the sweep, grown by the longest spring there may be.
bool farFromBlade(vec3 x, ToolMotion m, float h) {
  vec3 tip = m.to.xyz - m.from.xyz, far_from = m.blade_from.xyz - m.from.xyz, far_to = m.blade_to.xyz - m.from.xyz;
  vec3 centre = 0.25 * (tip + far_from + far_to);
  precise float radius = max(max(length(centre), distance(centre, tip)), max(distance(centre, far_from), distance(centre, far_to)));
  return distance(x, centre) > radius + kLongest * 1.41421356 * h + m.blade_from.w;
}

/// The near end has been found not to be far; the far end must not be either, or the two ends would disagree.
bool severs(uint slot, vec3 x, uint other, ToolMotion m, float h) {
  vec3 y = seenFromBlade(other, m);
  if (farFromBlade(y, m, h)) return false;
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
  vec3 x = seenFromBlade(slot, m);
  float h = bodies[bodyOf(bits)].origin_spacing.w;
  if (isIsolated(bits) || farFromBlade(x, m, h)) return;
  NodeBits whole = bits;
  uint cut = 0u;
#define CUT_SPRING(spring, offset)                              \
  if (springCount(whole, spring) != 0u) {                       \
    uint n = neighborSlot(slot, offset);                        \
    if (severs(slot, x, n, m, h)) {                                \
      bits = withoutSpring(bits, spring);                       \
      cut += slot < n ? 1u : 0u;                                \
    }                                                           \
  }
  FOR_EACH_SPRING(CUT_SPRING)
  if (bits == whole) return;
  nodes[slot] = bits;
  if (cut != 0u) atomicAdd(stats.springs_cut, cut);
}
