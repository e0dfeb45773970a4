// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What keeps a cell from being turned inside out (physics.md 1, Crushed cells): a pressure at each corner where the cell's three edges
// span less than kCrushed of their volume at rest. Springs alone let go there: squeezed to a half, they resist hardly more. In moments.glsl.

/// Sides of a corner, -1 or 1. @param number  bit per axis, x lowest
vec3 cornerSide(uint number) {
  return vec3((number & 1u) != 0u ? 1.0f : -1.0f, (number & 2u) != 0u ? 1.0f : -1.0f, (number & 4u) != 0u ? 1.0f : -1.0f);
}

const float kRootHalf = 0.70710678f;

/// The three edges at a corner of a cell, over h.
struct CornerEdges {
  vec3 a, b, c;
};
CornerEdges cornerEdges(CellMotion q, vec3 s) {
  CornerEdges e = {vec3(1.0f, 0.0f, 0.0f) + q.da + 0.5f * (s.y * q.hz + s.z * q.hy) + (kRootHalf * s.y * s.z) * q.hxyz,
                   vec3(0.0f, 1.0f, 0.0f) + q.db + 0.5f * (s.z * q.hx + s.x * q.hz) + (kRootHalf * s.z * s.x) * q.hxyz,
                   vec3(0.0f, 0.0f, 1.0f) + q.dc + 0.5f * (s.x * q.hy + s.y * q.hx) + (kRootHalf * s.x * s.y) * q.hxyz};
  return e;
}

/// False only where no corner is crushed: by kNearRest2; where the cell has turned or is strained, by the volume of its mean edges less
/// what hourglass motions can take off that.
bool mayBeCrushed(CellMotion q) {
  float crossed = dot(q.hxyz, q.hxyz), bent = dot(q.hx, q.hx) + dot(q.hy, q.hy) + dot(q.hz, q.hz) + 2.0f * crossed;
  float f2 = dot(q.da, q.da) + dot(q.db, q.db) + dot(q.dc, q.dc), d2 = 1.5f * (bent + crossed);
  float left = kNearRest2 - f2 - d2;
  if (left > 0.0f && 4.0f * f2 * d2 < left * left) return false;
  vec3 a = vec3(1.0f, 0.0f, 0.0f) + q.da, b = vec3(0.0f, 1.0f, 0.0f) + q.db, c = vec3(0.0f, 0.0f, 1.0f) + q.dc;
  float change = sqrt(0.75f * bent), size = sqrt(max(dot(a, a), max(dot(b, b), dot(c, c))));  // of an edge, at most
  return dot(a, cross(b, c)) - change * (3.0f * size * size + change * (3.0f * size + change)) < kCrushed;
}

/// Adds energy and derivatives: rigidity kCrushing/8 sum of (kCrushed - J)^2 / 2, beyond kMostCrushed by the tangent there.
void addCrushed(CellMotion q, float rigidity, INOUT(CellPull) pull) {
  float energy = 0.0f, weight = 0.125f * kCrushing * rigidity;
  for (uint corner = 0u; corner < 8u; ++corner) {
    vec3 s = cornerSide(corner);
    CornerEdges e = cornerEdges(q, s);
    vec3 bc = cross(e.b, e.c), ca = cross(e.c, e.a), ab = cross(e.a, e.b);
    float lacks = max(kCrushed - dot(e.a, bc), 0.0f), slope = min(lacks, kMostCrushed);
    energy += slope * (lacks - 0.5f * slope);
    vec3 a = (-weight * slope) * bc, b = (-weight * slope) * ca, c = (-weight * slope) * ab;
    pull.a += a;
    pull.b += b;
    pull.c += c;
    pull.hx += 0.5f * (s.z * b + s.y * c);
    pull.hy += 0.5f * (s.z * a + s.x * c);
    pull.hz += 0.5f * (s.y * a + s.x * b);
    pull.hxyz += kRootHalf * (s.y * s.z * a + s.z * s.x * b + s.x * s.y * c);
  }
  pull.energy += weight * energy;
}
