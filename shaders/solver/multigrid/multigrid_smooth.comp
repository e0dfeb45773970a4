// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// multigrid_smooth.comp - a step of Chebyshev's iteration: d = a d + b D^-1 r, z += d.
// Owner: solver/gpu/steps/multigrid_stages.h   physics.md 2
// in  a residual, inverse of the block diagonal     in, out  change, correction
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/multigrid/multigrid.glsl"

uniform uint r_vector;
uniform float a;
uniform float b;
uniform uint first;  // 1: the correction begins

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  vec3 r = ofSystem(r_vector, slot);
  vec4 m = system_vectors[kSystemInverse * slot_count + slot], n = system_vectors[kSystemInverse2 * slot_count + slot];
  vec3 next = b * vec3(dot(m.xyz, r), m.y * r.x + m.w * r.y + n.x * r.z, m.z * r.x + n.x * r.y + n.y * r.z);
  if (a != 0.0f) next += a * ofSystem(kSystemChange, slot);
  next = projected(slot, next);
  setOfSystem(kSystemChange, slot, next);
  setOfSystem(kSystemCorrection, slot, first != 0u ? next : ofSystem(kSystemCorrection, slot) + next);
}
