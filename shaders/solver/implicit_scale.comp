// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// implicit_scale.comp - increments = the share of them that implicit_fold.comp chose. One share is 0, so P is P(0) or below from
// there on, whatever the increments were.   Owner: solver/gpu/implicit_substep.h   physics.md 2
// in, out  increments [slots]
#include "layout.h"
#include "lattice.glsl"
#include "elastic.glsl"
#include "step.glsl"
#include "implicit.glsl"

#ifndef __cplusplus
layout(std430, binding = kBindIncrement) buffer IncrementBuffer { vec4 increments[]; };
#endif

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  vec4 du = increments[slot];
  if (du.w == 0.0f) increments[slot] = vec4(xyz(du) * uintBitsToFloat(guard[0]), 0.0f);
}
