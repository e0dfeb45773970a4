// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// slow.comp - limits the displacement of the last substep and reduces the velocity, in tissue that recovers.
// Owner: solver/gpu/slow_pass.h   physics.md 3
// in, out  displacement, velocity [slots], in place
#include "layout.h"
#include "solver/tissue/lattice.glsl"

layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindDisplacementIn) buffer DisplacementBuffer { vec4 current_displacement[]; };
layout(std430, binding = kBindVelocityIn) buffer VelocityBuffer { vec4 current_velocity[]; };

uniform uint active_count;
uniform float dt_s;
uniform float most_step;  // largest displacement in a substep, over the spacing
uniform float keeps;     // share of the velocity

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  vec3 v = current_velocity[slot].xyz;
  float most = most_step * bodies[bodyAt(slot)].origin_spacing.w / dt_s, speed = length(v);
  float share = speed > most ? most / speed : 1.0;
  current_displacement[slot].xyz -= (1.0 - share) * dt_s * v;
  current_velocity[slot].xyz = keeps * share * v;
}
