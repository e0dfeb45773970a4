// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// multigrid_begin.comp - a step begins: velocities, and the force that has changed them since the last one.
// Owner: solver/gpu/steps/multigrid_stages.h   physics.md 2
// in  displacement, velocity [slots]     out  vectors of the step
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/multigrid/multigrid.glsl"

uniform uint fresh;  // 1: how the last step ended is unknown

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  vec3 u = stateAt(displacement, int(slot)).xyz, v = stateAt(velocity, int(slot)).xyz;
  // What guard.comp put back is not where the last step ended.
  bool known = fresh == 0u && ofStep(kStepEnded, slot) == u;
  vec3 before = known ? ofStep(kStepLeft, slot) : v;
  setOfStep(kStepVelocity, slot, before);
  setOfStep(kStepLoad, slot, nodeMass(slot, bits, bodies[bodyOf(bits)]) * (v - before) / dt_s);
  setOfStep(kStepPlace, slot, u);
  setOfStep(kStepSpeed, slot, before);
  setOfStep(kStepIncrement, slot, vec3(0.0f));
  system_vectors[kSystemInverse2 * slot_count + slot].w = isAtRest(bits) ? 0.0f : 1.0f;
}
