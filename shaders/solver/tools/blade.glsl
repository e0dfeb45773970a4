// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Geometry of a swept blade and of an eraser (VR05 2.7.3). All vectors are relative to the blade's first tip.
// From either end of a spring the test is called with the ends in the same order, at one place in the text (cut.comp). A compiler
// that evaluates a second copy of the test in another order would cut a spring on one side only. All decisions use `precise`.
#include "layout/blade.h"

/// Returns six times the signed volume of the tetrahedron (o, a, b, c) with o at the origin of the vectors.
float triple(vec3 a, vec3 b, vec3 c) {
  precise float v = dot(cross(a, b), c);
  return v;
}

/// Returns whether the segment a..b crosses the triangle p q r, including its edges. A point on the plane counts as on one side,
/// so no end is between.
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
/// Returns which of its two triangles the segment a..b crosses, 1 or 2; 0 if none.
uint crossedPart(vec3 a, vec3 b, ToolMotion m) {
  precise vec3 tip = xyz(m.to) - xyz(m.from), far_from = xyz(m.blade_from) - xyz(m.from), far_to = xyz(m.blade_to) - xyz(m.from);
  if (crossesTriangle(a, b, vec3(0.0f), far_from, far_to)) return 1u;
  return crossesTriangle(a, b, vec3(0.0f), far_to, tip) ? 2u : 0u;
}

// kOverlap (layout/blade.h) of a sweep: it begins this far before the end of the last one, against rounding.

/// Returns the offset of the start of the sweep for a spring that has moved by `way` since the last one: there the last sweep
/// ended, as seen by the spring. Without it, a spring that slips past the blade's edge between two substeps would be in neither
/// sweep.
vec3 startOffset(ToolMotion m, vec3 relative) {
  precise vec3 offset = relative - kOverlap * (xyz(m.to) - xyz(m.from));
  return offset;
}

/// Returns the same for a blade that cuts along its edge only. Tissue that moves sideways against its flats is not cut; tissue
/// that moves along the blade's path is. A blade at rest cuts nothing.
vec3 startOffsetAlong(ToolMotion m, vec3 relative) {
  precise vec3 move = (xyz(m.to) - xyz(m.from)) + (xyz(m.blade_to) - xyz(m.blade_from));
  precise float move2 = dot(move, move);
  precise vec3 offset = move2 > 0.0f ? (dot(relative, move) / move2) * move - kOverlap * (xyz(m.to) - xyz(m.from)) : vec3(0.0f);
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

const float kLeastShare = 0.02f;  // a cut is not recorded nearer to an end of the spring than this share of its length

/// Returns where the line a..b crosses the plane of a triangle of the sweep, as the share of a..b on a's side. If a and b are on
/// the same side of it, returns the nearer end.
/// @param part  1 or 2, from crossedPart()
float shareBefore(vec3 a, vec3 b, uint part, ToolMotion m) {
  vec3 tip = xyz(m.to) - xyz(m.from), far_from = xyz(m.blade_from) - xyz(m.from), far_to = xyz(m.blade_to) - xyz(m.from);
  // The cross product of the blade and a displacement: that of two almost equal blades would lose its digits.
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

/// Returns whether a node is within the eraser's radius of the swept blade.
bool erased(vec3 x, ToolMotion m) {
  vec3 tip = xyz(m.to) - xyz(m.from), far_from = xyz(m.blade_from) - xyz(m.from), far_to = xyz(m.blade_to) - xyz(m.from);
  precise float d = min(min(segmentDistance(vec3(0.0f), far_from, x), segmentDistance(tip, far_to, x)),
                        min(segmentDistance(vec3(0.0f), tip, x), segmentDistance(far_from, far_to, x)));
  d = planeDistanceInside(vec3(0.0f), far_from, far_to, x, d);
  d = planeDistanceInside(vec3(0.0f), far_to, tip, x, d);
  return d <= m.blade_from.w;
}

/// Returns a sphere around everything that the sweep may cut: around the sweep itself, enlarged by the longest possible spring.
/// xyz centre relative to the blade's first tip [m], w radius [m].
vec4 bladeSphere(ToolMotion m, float h) {
  vec3 tip = xyz(m.to) - xyz(m.from), far_from = xyz(m.blade_from) - xyz(m.from), far_to = xyz(m.blade_to) - xyz(m.from);
  vec3 centre = 0.25f * (tip + far_from + far_to);
  precise float radius = max(max(length(centre), distance(centre, tip)), max(distance(centre, far_from), distance(centre, far_to)));
  return vec4(centre, radius + kLongest * 1.41421356f * h + m.blade_from.w);
}

/// Returns whether a point is outside the sphere. @param sphere  bladeSphere()
bool farFromBlade(vec3 x, vec4 sphere) {
  precise float away = distance(x, xyz(sphere));
  return away > sphere.w;
}
