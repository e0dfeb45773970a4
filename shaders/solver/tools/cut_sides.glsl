// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// On which side of a cut nodes are: a node keeps the side on which the blade first met it, while tissue sways in the wound. Without
// this a row of nodes near the blade's way would lose springs on either side of it, and crumble. After blade.glsl.
#ifndef __cplusplus
layout(std430, binding = kBindCutSides) buffer CutSidesBuffer { vec4 cut_sides[]; };  // xyz unit normal towards the node's side; w 1: known
#endif

const float kSameCut = 0.7f;  // cosine between two blades' ways above which both run along one cut
const float kSway = 0.5f;     // cells: a node farther beyond the blade is on the other side of another cut
const float kBeside = 1e-3f;  // cells from the blade at which one that has swayed across it is seen

/// Unit normal of a sweep, as a whole where it turns; 0 where the blade does not move across itself.
vec3 sweepNormal(ToolMotion m) {
  vec3 blade = (xyz(m.blade_from) - xyz(m.from)) + (xyz(m.blade_to) - xyz(m.to));
  vec3 move = (xyz(m.to) - xyz(m.from)) + (xyz(m.blade_to) - xyz(m.blade_from));
  precise vec3 normal = cross(blade, move);
  precise float size2 = dot(normal, normal);
  precise vec3 unit = size2 > 0.0f ? normal * inversesqrt(size2) : vec3(0.0f);
  return unit;
}

/// Where the blade sees a node: on its own side. That both ends of a spring see the same whether or not the other one has been
/// remembered in this pass rests on this: one that has just been is on its side.
/// @param x  from the blade's first tip
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

/// Of a node that loses a spring. @param x  from the blade's first tip
void rememberSide(uint slot, vec3 x, ToolMotion m) {
  vec4 side = cut_sides[slot];
  vec3 normal = sweepNormal(m);
  if (side.w != 0.0f && abs(dot(normal, xyz(side))) >= kSameCut) return;
  precise float away = dot(x, normal);
  cut_sides[slot] = vec4(away >= 0.0f ? normal : -normal, 1.0f);
}
