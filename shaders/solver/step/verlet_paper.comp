// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// verlet_paper.comp - position Verlet as printed in VR05 and GW, in absolute float32 positions.
// Owner: solver/gpu/steps/verlet_paper_pass.h
// physics.md 2: x+ = 2 x - x_prev + dt^2 a,  a = F/m + g - gamma (x - x_prev)/dt;  k is the true one; there is no dashpot.
// in  x, x_prev [slots]     out  x+ (in place of x_prev); displacement x - x_rest, velocity (x+ - x)/dt for other kernels
// Features: REBUILD makes x and x_prev from displacement and velocity; TOOLS, PARTS as in leapfrog.comp.
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"

#ifndef __cplusplus
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindPositionsBefore) buffer PositionsBefore { vec4 positions_before[]; };
#ifdef REBUILD
layout(std430, binding = kBindPositions) writeonly buffer Positions { vec4 rebuilt_positions[]; };
#else
layout(binding = kUnitPositions) uniform samplerBuffer positions;
layout(std430, binding = kBindDisplacementOut) writeonly buffer DisplacementOut { vec4 next_displacement[]; };
layout(std430, binding = kBindVelocityOut) writeonly buffer VelocityOut { vec4 next_velocity[]; };
#endif
#endif

#include "solver/tissue/step.glsl"
#ifdef TOOLS
#include "solver/tools/contact.glsl"
#endif

#ifdef REBUILD
void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  vec3 x = restPosition(slot) + xyz(stateAt(displacement, int(slot)));
  rebuilt_positions[slot] = vec4(x, 0.0f);
  positions_before[slot] = vec4(x - dt_s * xyz(stateAt(velocity, int(slot))), 0.0f);
}
#else
/// Returns the sum of the forces of springs [N], from absolute positions: L - l0 cancels, as printed.
vec3 elasticForce(uint slot, NodeBits bits, BodyParams body, vec3 x) {
  vec3 force = vec3(0.0f);
#define VISIT_LINK                                                                \
  vec3 edge = xyz(texelFetch(positions, int(n))) - x;                             \
  float l = length(edge);                                                         \
  if (l > kShortest * l0) force += (k * (l - l0)) * (edge / l);                   \
  else if (l0 > 0.0f) force += (k * (l - l0)) * (d / l0);
  FOR_EACH_LINK
#undef VISIT_LINK
  return force;
}

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  vec3 rest = restPosition(slot);
  vec3 x = xyz(texelFetch(positions, int(slot)));
  vec3 u = xyz(stateAt(displacement, int(slot)));
  if (isAtRest(bits)) {
    positions_before[slot] = vec4(x, 0.0f);
    next_displacement[slot] = vec4(u, 0.0f);
    next_velocity[slot] = vec4(0.0f);
    return;
  }
  BodyParams body = bodies[bodyOf(bits)];
  // The velocity that x_prev represents. If a tool has changed the velocity since, x_prev is recomputed from it.
  vec3 v = xyz(stateAt(velocity, int(slot)));
  precise vec3 x_prev = xyz(positions_before[slot]);
  precise vec3 v_stored = (x - x_prev) / dt_s;
  if (v != v_stored) x_prev = x - dt_s * v;

  float mass = nodeMass(slot, bits, body);
  vec3 a = elasticForce(slot, bits, body, x) / mass + gravity - body.mass_damping_per_s * ((x - x_prev) / dt_s);
  precise vec3 x_next = 2.0f * x - x_prev + dt_s * dt_s * a;
  precise vec3 v_next = (x_next - x) / dt_s;
  precise vec3 u_next = x_next - rest;
  vec3 u_free = u_next;
#ifdef TOOLS
  resolveContacts(slot, bits, mass, u, u_next, v_next);
#endif
  fallAsleep(bits, u, u_next, v_next);
  if (u_next != u_free) x_next = rest + u_next;
  positions_before[slot] = vec4(x_next, 0.0f);
  next_displacement[slot] = vec4(u_next, 0.0f);
  next_velocity[slot] = vec4(v_next, 0.0f);
}
#endif
