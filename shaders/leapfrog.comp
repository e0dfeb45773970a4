// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// leapfrog.comp - advance every active node by one leapfrog substep.   Owner: solver/gpu/leapfrog_pass.h   physics.md 2, 5
// in  displacement, velocity [slots]     out  displacement, velocity [slots]; impulses [kMaxStyluses * slots]
// Features: DASHPOT (axial dashpot), TOOLS (probe and held nodes), VOLUME, PARTS (elastic.glsl), COMPENSATED (Kahan's sums of u and v).
#include "layout.h"
#include "lattice.glsl"
#include "elastic.glsl"

layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementOut) writeonly buffer DisplacementOut { vec4 next_displacement[]; };
layout(std430, binding = kBindVelocityOut) writeonly buffer VelocityOut { vec4 next_velocity[]; };
#ifdef COMPENSATED
layout(std430, binding = kBindCompensation) buffer CompensationBuffer { vec4 compensation[]; };
#endif

#include "step.glsl"
#ifdef TOOLS
#include "contact.glsl"
#endif

/// Sum of the forces of springs, dashpots and volumes on a node [N].
vec3 latticeForce(uint slot, NodeBits bits, BodyParams body, vec3 u, vec3 v) {
  float h = body.origin_spacing.w;
  vec3 force = vec3(0.0);
#ifdef DASHPOT
#define DASHPOT_FORCE(k, n, s) force += (k * body.dashpot_s * dot(texelFetch(velocity, int(n)).xyz - v, s.direction)) * s.direction;
#else
#define DASHPOT_FORCE(k, n, s)
#endif
#define ADD_SPRING(spring, offset)                                                              \
  {                                                                                             \
    uint count = springCount(bits, spring);                                                     \
    if (count != 0u) {                                                                          \
      uint n = neighborSlot(slot, offset);                                                      \
      float k = springStiffness(slot, n, spring, count, body);                                  \
      float l0 = spring < kAxialSprings ? h : kSqrt2 * h;                                       \
      Spring s = springBetween(h * vec3(offset), l0, texelFetch(displacement, int(n)).xyz - u); \
      force += (k * s.extension) * s.direction;                                                 \
      DASHPOT_FORCE(k, n, s)                                                                    \
    }                                                                                           \
  }
  FOR_EACH_SPRING(ADD_SPRING)
#ifdef VOLUME
  force += volumeForce(slot).xyz;
#endif
  return force;
}

/// sum + increment. Kahan: what the last sums lost is added first, what this one loses is kept. @param of  compensation's index
vec3 added(uint of, vec3 sum, vec3 increment) {
#ifdef COMPENSATED
  precise vec3 all_of_it = increment - compensation[of].xyz;
  precise vec3 next = sum + all_of_it;
  precise vec3 lost = (next - sum) - all_of_it;
  compensation[of] = vec4(lost, 0.0);
  return next;
#else
  return sum + increment;
#endif
}

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  vec3 u = texelFetch(displacement, int(slot)).xyz;
  if (isAtRest(bits)) {
    next_displacement[slot] = vec4(u, 0.0);
    next_velocity[slot] = vec4(0.0);
    return;
  }
  BodyParams body = bodies[bodyOf(bits)];
  vec3 v = texelFetch(velocity, int(slot)).xyz;
  float mass = nodeMass(slot, bits, body);
  vec3 acceleration = latticeForce(slot, bits, body, u, v) / mass + gravity;

  // ((1 - g) v + kick a) / (1 + g), as v and an increment: rounding 1 - g would be a drag of its own, the same in every substep.
  float g = 0.5 * body.drag_per_s * kick_s;
  vec3 v_next = added(2u * slot + 1u, v, (kick_s * acceleration - (2.0 * g) * v) / (1.0 + g));
  vec3 u_next = added(2u * slot, u, dt_s * v_next);
#ifdef TOOLS
  resolveContacts(slot, bits, mass, u, u_next, v_next);
#endif
  fallAsleep(bits, u, u_next, v_next);
  next_displacement[slot] = vec4(u_next, 0.0);
  next_velocity[slot] = vec4(v_next, 0.0);
}
