// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Contacts between nodes: which may touch, which are near, and the direction of their forces (solver/contact/collision.h,
// physics.md 8). After lattice.glsl and elastic.glsl.
// Feature: AHEAD (within an implicit substep: "before" is the current state, and the end is given by the increments).
#ifndef __cplusplus
uniform uint active_count;
uniform float dt_s;
uniform float push_speed;     // m/s
uniform float resting_speed;  // m/s: slower impacts do not bounce
uniform float cell_m;
uniform float widened;        // factor on D_ij below which two nodes touch
uniform uint bucket_count;    // power of 2
uniform float friction;
uniform float restitution;
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementOut) readonly buffer DisplacementOut { vec4 next_displacement[]; };  // before the substep
layout(std430, binding = kBindTouchDepths) readonly buffer TouchDepthsBuffer { float touch_depths[]; };
layout(std140, binding = kBindBodyInfluences) uniform BodyInfluencesBlock { vec4 body_influences[kMaxBodies]; };  // w distance [m]
layout(std430, binding = kBindContacts) buffer ContactsBuffer { vec4 contacts[]; };
layout(std430, binding = kBindCorrections) buffer CorrectionsBuffer { vec4 corrections[]; };
layout(std430, binding = kBindBuckets) buffer BucketsBuffer { uint buckets[]; };
layout(std430, binding = kBindUnsorted) buffer UnsortedBuffer { uint unsorted[]; };
layout(std430, binding = kBindEntries) buffer EntriesBuffer { uvec4 entries[]; };
layout(std430, binding = kBindEntriesBefore) buffer EntriesBeforeBuffer { vec4 entries_before[]; };
#endif

/// A node that may touch others.
struct Entry {
  uint slot;
  vec3 x;       // at the end of the substep [m]
  vec3 before;  // at its start [m]
};

#ifdef AHEAD
vec3 positionBefore(uint slot) { return restPosition(slot) + xyz(stateAt(displacement, int(slot))); }
vec3 positionOf(uint slot) { return positionBefore(slot) + xyz(stateAt(increment, int(slot))); }
#else
vec3 positionOf(uint slot) { return restPosition(slot) + xyz(stateAt(displacement, int(slot))); }
vec3 positionBefore(uint slot) { return restPosition(slot) + xyz(next_displacement[slot]); }
#endif

/// Returns whether this node may touch others. A node too far away for integer cells, or not finite, may not.
bool collides(uint slot, NodeBits bits, vec3 x) {
  if (isIsolated(bits)) return false;
  float depth = touch_depths[slot];
  if (depth == kNeverTouches || ((bits.lo & kSeveredBit) == 0u && depth == kTouchesOnceCut)) return false;
  const float most_cells = 1e9f;  // in either direction: coordinates of cells are 32-bit integers
  return all(lessThanEqual(floatBitsToUint(abs(x)), uvec3(floatBitsToUint(most_cells * cell_m))));
}

ivec3 cellOf(vec3 x) { return ivec3(floor(x / cell_m)); }

uint hashOf(ivec3 cell) {
  uint h = uint(cell.x) * 73856093u ^ uint(cell.y) * 19349663u ^ uint(cell.z) * 83492791u;
  return h ^ (h >> 15);
}

/// Returns the depth below the surface of its tissue of a node that may touch others [m].
float touchDepth(uint slot) {
  float depth = touch_depths[slot];
  return depth == kTouchesOnceCut ? 0.0f : depth;
}

/// Returns the contact distance of nodes of two bodies, times `widened` [m]: their surfaces keep the larger distance of the
/// bodies.
float distanceBetweenBodies(uint a, uint b) {
  float wanted = max(body_influences[bodyOf(nodes[a])].w, body_influences[bodyOf(nodes[b])].w);
  return widened * (wanted + (touchDepth(a) + touchDepth(b)));
}

/// Returns the contact distance of two nodes, D_ij of collision.h, times `widened` [m]: the same number for both.
float contactDistance(uint a, uint b) {
  float wanted = distanceBetweenBodies(a, b);
  if (bodyOf(nodes[a]) != bodyOf(nodes[b])) return wanted;
  return min(wanted, widened * (0.5f * distance(restPosition(a), restPosition(b))));
}

/// Returns contactDistance() if two nodes touch, else 0 [m].
float touchDistance(Entry a, Entry b) {
  precise vec3 apart = a.x - b.x;
  float d2 = dot(apart, apart);
  float wanted = distanceBetweenBodies(a.slot, b.slot);
  if (d2 >= wanted * wanted) return 0.0f;
  wanted = contactDistance(a.slot, b.slot);
  return d2 < wanted * wanted ? wanted : 0.0f;
}

/// Returns the direction from b to a before the substep: a node that has passed another in it is pushed back.
/// @param a  has the lower slot, so that both compute the same
vec3 directionBetween(Entry a, Entry b) {
  vec3 d = a.before - b.before;
  float l = length(d);
  if (l > 0.0f) return d / l;
  d = a.x - b.x;
  l = length(d);
  return l > 0.0f ? d / l : vec3(0.0f, 0.0f, 1.0f);
}

/// Returns the inverse mass [1/kg]; 0 for nodes with one of these bits.
float inverseMassWithout(uint slot, uint unmoved) {
  NodeBits bits = nodes[slot];
  return (bits.lo & unmoved) != 0u ? 0.0f : 1.0f / nodeMass(slot, bits, bodies[bodyOf(bits)]);
}

/// Returns the inverse mass [1/kg]; 0 for nodes that contacts do not move.
float inverseMass(uint slot) { return inverseMassWithout(slot, kFixedBit | kGrabMask); }

/// Returns the normal of a contact: that of the sheet on which one of the two rests. It is the mean of the directions at the node
/// with more contacts, or else the line through both. @param dir  directionBetween   @param sum_a, sum_b  contacts[]
vec3 contactNormal(vec3 dir, vec4 sum_a, vec4 sum_b) {
  vec3 sum = vec3(0.0f);
  if (sum_a.w >= sum_b.w) sum += xyz(sum_a);
  if (sum_b.w >= sum_a.w) sum -= xyz(sum_b);
  float l = length(sum);
  const float least = 0.05f;  // cosine: a mean at a larger angle says nothing about this contact
  return l > 0.0f && dot(sum, dir) > least * l ? sum / l : dir;
}
