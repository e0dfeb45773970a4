// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a swept blade crosses and what an eraser reaches (VR05 2.7.3). All vectors are from the blade's first tip.
// Who asks from either end of a spring asks in the same order of ends, at one place in its text (cut.comp): a compiler that makes
// another sum of a test where it is written down again would cut a spring on one side only. All verdicts rest on `precise`.
#include "layout/blade.h"

/// Six times the signed volume of the tetrahedron (o, a, b, c) with o at the origin of the vectors.
float triple(vec3 a, vec3 b, vec3 c) {
  precise float v = dot(cross(a, b), c);
  return v;
}

/// Does the segment a..b cross the triangle p q r? One end belongs to a side, so no end lies between; edges belong to it.
bool crossesTriangle(vec3 a, vec3 b, vec3 p, vec3 q, vec3 r) {
  precise vec3 normal = cross(q - p, r - p);
  precise float area2 = dot(normal, normal), side_a = dot(a - p, normal), side_b = dot(b - p, normal);
  if (area2 == 0.0f) return false;  // the blade did not move
  if ((side_a >= 0.0f) == (side_b >= 0.0f)) return false;
  precise vec3 ab = b - a;
  float pq = triple(p - a, q - a, ab), qr = triple(q - a, r - a, ab), rp = triple(r - a, p - a, ab);
  return (pq >= 0.0f && qr >= 0.0f && rp >= 0.0f) || (pq <= 0.0f && qr <= 0.0f && rp <= 0.0f);
}

/// The blade sweeps a quadrilateral: tip and far end at the start, far end and tip at the end.
/// Which of its two triangles the segment a..b crosses, 1 or 2; 0 where it crosses none.
uint crossedPart(vec3 a, vec3 b, ToolMotion m) {
  precise vec3 tip = xyz(m.to) - xyz(m.from), far_from = xyz(m.blade_from) - xyz(m.from), far_to = xyz(m.blade_to) - xyz(m.from);
  if (crossesTriangle(a, b, vec3(0.0f), far_from, far_to)) return 1u;
  return crossesTriangle(a, b, vec3(0.0f), far_to, tip) ? 2u : 0u;
}

// kOverlap (layout/blade.h) of a sweep: it begins that much before the end of the last one, whatever is rounded.

/// What the start of the sweep is moved by for a spring that has come `way` since the last one: there the last sweep ended, as the
/// spring saw it. Without this, one that slips past the blade's edge between two substeps would be in neither sweep.
vec3 startOffset(ToolMotion m, vec3 way) {
  precise vec3 offset = way - kOverlap * (xyz(m.to) - xyz(m.from));
  return offset;
}

/// The same of a blade that cuts along its edge only: what sways sideways against its flats stays whole, and what comes along its way
/// does not; one at rest cuts nothing.
vec3 startOffsetAlong(ToolMotion m, vec3 way) {
  precise vec3 move = (xyz(m.to) - xyz(m.from)) + (xyz(m.blade_to) - xyz(m.blade_from));
  precise float move2 = dot(move, move);
  precise vec3 offset = move2 > 0.0f ? (dot(way, move) / move2) * move - kOverlap * (xyz(m.to) - xyz(m.from)) : vec3(0.0f);
  return offset;
}

ToolMotion startingAt(ToolMotion m, vec3 offset) {
  m.from.x += offset.x;
  m.from.y += offset.y;
  m.from.z += offset.z;
  m.blade_from.x += offset.x;
  m.blade_from.y += offset.y;
  m.blade_from.z += offset.z;
  return m;
}

const float kLeastShare = 0.02f;  // a spring is not shown cut nearer to one of its ends than this share of it

/// Where the line a..b passes the plane of a part of the sweep: the share of a..b on a's side. Where a and b lie on the same
/// side of it, at the nearer end.
/// @param part  1 or 2, as crossedPart() says
float shareBefore(vec3 a, vec3 b, uint part, ToolMotion m) {
  vec3 tip = xyz(m.to) - xyz(m.from), far_from = xyz(m.blade_from) - xyz(m.from), far_to = xyz(m.blade_to) - xyz(m.from);
  // Of two vectors of which one is the blade and the other a way: of two blades that are almost one another little is left.
  vec3 normal = part == 1u ? cross(far_from, xyz(m.blade_to) - xyz(m.blade_from)) : cross(far_to, tip);
  float da = dot(a, normal), db = dot(b, normal);
  return da == db ? 0.5f : clamp(da / (da - db), kLeastShare, 1.0f - kLeastShare);
}

float segmentDistance(vec3 a, vec3 b, vec3 x) {
  precise vec3 ab = b - a;
  precise float length2 = dot(ab, ab), along = dot(x - a, ab);
  precise vec3 nearest = length2 > 0.0f ? a + clamp(along / length2, 0.0f, 1.0f) * ab : a;
  precise float out_m = distance(x, nearest);
  return out_m;
}

float planeDistanceInside(vec3 p, vec3 q, vec3 r, vec3 x, float otherwise) {
  precise vec3 normal = cross(q - p, r - p);
  precise float area2 = dot(normal, normal);
  if (area2 == 0.0f) return otherwise;
  precise float pq = dot(cross(q - p, x - p), normal), qr = dot(cross(r - q, x - q), normal), rp = dot(cross(p - r, x - r), normal);
  precise float away = abs(dot(x - p, normal)) / sqrt(area2);
  return pq >= 0.0f && qr >= 0.0f && rp >= 0.0f ? min(otherwise, away) : otherwise;
}

/// Is a node within the eraser's radius of the swept blade?
bool erased(vec3 x, ToolMotion m) {
  vec3 tip = xyz(m.to) - xyz(m.from), far_from = xyz(m.blade_from) - xyz(m.from), far_to = xyz(m.blade_to) - xyz(m.from);
  precise float d = min(min(segmentDistance(vec3(0.0f), far_from, x), segmentDistance(tip, far_to, x)),
                        min(segmentDistance(vec3(0.0f), tip, x), segmentDistance(far_from, far_to, x)));
  d = planeDistanceInside(vec3(0.0f), far_from, far_to, x, d);
  d = planeDistanceInside(vec3(0.0f), far_to, tip, x, d);
  return d <= m.blade_from.w;
}

/// Sphere around all that the sweep may cut: around the sweep itself, grown by the longest spring there may be. xyz centre,
/// from the blade's first tip [m], w radius [m].
vec4 bladeSphere(ToolMotion m, float h) {
  vec3 tip = xyz(m.to) - xyz(m.from), far_from = xyz(m.blade_from) - xyz(m.from), far_to = xyz(m.blade_to) - xyz(m.from);
  vec3 centre = 0.25f * (tip + far_from + far_to);
  precise float radius = max(max(length(centre), distance(centre, tip)), max(distance(centre, far_from), distance(centre, far_to)));
  return vec4(centre, radius + kLongest * 1.41421356f * h + m.blade_from.w);
}

/// @param sphere  bladeSphere()
bool farFromBlade(vec3 x, vec4 sphere) {
  precise float away = distance(x, xyz(sphere));
  return away > sphere.w;
}
