// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Side of a cut on which nodes are. A node keeps the side on which the blade first met it, although tissue moves in the wound.
// Without this, a row of nodes near the blade's path would lose springs on both sides and crumble. After blade.glsl.
#ifndef __cplusplus
layout(std430, binding = kBindCutSides) buffer CutSidesBuffer { vec4 cut_sides[]; };  // xyz unit normal towards the node's side; w 1: known
#endif

const float kSameCut = 0.7f;  // cosine between the normals of two sweeps above which they belong to one cut
const float kSway = 0.5f;     // in cells: a node farther beyond the blade is on the other side of another cut
const float kBeside = 1e-3f;  // in cells: distance from the blade at which a node that has moved across it is placed

/// Returns the unit normal of a sweep, averaged where it turns; 0 if the blade does not move across itself.
vec3 sweepNormal(ToolMotion m) {
  vec3 blade = (xyz(m.blade_from) - xyz(m.from)) + (xyz(m.blade_to) - xyz(m.to));
  vec3 move = (xyz(m.to) - xyz(m.from)) + (xyz(m.blade_to) - xyz(m.blade_from));
  precise vec3 normal = cross(blade, move);
  precise float size2 = dot(normal, normal);
  precise vec3 unit = size2 > 0.0f ? normal * inversesqrt(size2) : vec3(0.0f);
  return unit;
}

/// Returns the position of a node as the blade sees it: on its own side. A node with a side recorded in this pass is on that
/// side, so both ends of a spring see the same whether or not the other has been recorded yet.
/// @param x  relative to the blade's first tip
vec3 onItsSide(uint slot, vec3 x, ToolMotion m, float h) {
  vec4 side = cut_sides[slot];
  if (side.w == 0.0f) return x;
  vec3 normal = sweepNormal(m);
  precise float same = dot(normal, xyz(side));
  if (abs(same) < kSameCut) return x;
  if (same < 0.0f) normal = -normal;
  precise float away = dot(x, normal);
  if (away >= 0.0f || away < -kSway * h) return x;
  precise vec3 beside = x + (kBeside * h - away) * normal;
  return beside;
}

/// Records the side of a node that loses a spring. @param x  relative to the blade's first tip
void rememberSide(uint slot, vec3 x, ToolMotion m) {
  vec4 side = cut_sides[slot];
  vec3 normal = sweepNormal(m);
  if (side.w != 0.0f && abs(dot(normal, xyz(side))) >= kSameCut) return;
  precise float away = dot(x, normal);
  cut_sides[slot] = vec4(away >= 0.0f ? normal : -normal, 1.0f);
}
