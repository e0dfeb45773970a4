// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// implicit_end.comp - end of a substep of implicit Euler: state = displacement + increment; momentum of tools, sleep.
// Owner: solver/gpu/implicit_substep.h   physics.md 2
// in  displacement, velocity, increments [slots]     out  displacement, velocity [slots]     Feature: TOOLS
#include "layout.h"
#include "lattice.glsl"
#include "elastic.glsl"
#include "step.glsl"
#include "implicit.glsl"
#ifdef TOOLS
#include "contact.glsl"
#endif

#ifndef __cplusplus
layout(std430, binding = kBindDisplacementOut) writeonly buffer DisplacementOut { vec4 next_displacement[]; };
layout(std430, binding = kBindVelocityOut) writeonly buffer VelocityOut { vec4 next_velocity[]; };
#endif

#ifdef TOOLS
/// The velocity that the lattice alone would have given a held node: its tool's momentum is counted from there.
vec3 velocityWithoutTool(uint slot, NodeBits bits, float mass, BodyParams body, vec3 u, vec3 du) {
  vec3 force = vec3(0.0f);
#define VISIT_LINK force += implicitSpring(n, u, du, d, l0, prestrain, k, body).force;
  FOR_EACH_LINK
#undef VISIT_LINK
#ifdef VOLUME
  force += xyz(volumeForce(slot));
#endif
  return (xyz(texelFetch(velocity, int(slot))) + dt_s * (force / mass + gravity)) / (1.0f + body.drag_per_s * dt_s);
}
#endif

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  vec3 u = xyz(texelFetch(displacement, int(slot)));
  if (isAtRest(bits)) {
    next_displacement[slot] = vec4(u, 0.0f);
    next_velocity[slot] = vec4(0.0f);
    return;
  }
  vec3 du = xyz(texelFetch(increment, int(slot)));
  vec3 u_next = u + du, v_next = du / dt_s;
#ifdef TOOLS
  BodyParams body = bodies[bodyOf(bits)];
  float mass = nodeMass(slot, bits, body);
  if ((bits.lo & kGrabMask) != 0u) v_next = velocityWithoutTool(slot, bits, mass, body, u, du);
  resolveContacts(slot, bits, mass, u, u_next, v_next);
#endif
  fallAsleep(bits, u, u_next, v_next);
  next_displacement[slot] = vec4(u_next, 0.0f);
  next_velocity[slot] = vec4(v_next, 0.0f);
}
