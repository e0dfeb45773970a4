// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// multigrid_end.comp - a step ends.   Owner: solver/gpu/steps/multigrid_stages.h   physics.md 2
// in  vectors of the step     out  displacement, velocity [slots]
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/multigrid/multigrid.glsl"

layout(std430, binding = kBindDisplacementOut) writeonly buffer DisplacementOut { vec4 next_displacement[]; };
layout(std430, binding = kBindVelocityOut) writeonly buffer VelocityOut { vec4 next_velocity[]; };

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  vec3 u = stateAt(displacement, int(slot)).xyz;
  vec3 u_next = u, v_next = vec3(0.0f);
  if (!isAtRest(bits)) {
    u_next = u + ofStep(kStepIncrement, slot);
    v_next = ofStep(kStepSpeed, slot);
    fallAsleep(bits, u, u_next, v_next);
  }
  next_displacement[slot] = vec4(u_next, 0.0f);
  next_velocity[slot] = vec4(v_next, 0.0f);
  setOfStep(kStepEnded, slot, u_next);
  setOfStep(kStepLeft, slot, v_next);
}
