// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// integrate.comp - advance every active node by one substep.   Owner: solver/gpu/integrate_pass.h   physics.md 2, 5
// in  displacement, velocity [slots]     out  displacement, velocity [slots]; impulses [kMaxStyluses * slots]
// Features: DASHPOT (axial dashpot), TOOLS (probe and held nodes).
#include "layout.h"
#include "lattice.glsl"
#include "spring.glsl"

layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(binding = kUnitDisplacement) uniform samplerBuffer displacement;
layout(binding = kUnitVelocity) uniform samplerBuffer velocity;
layout(std430, binding = kBindDisplacementOut) writeonly buffer DisplacementOut { vec4 next_displacement[]; };
layout(std430, binding = kBindVelocityOut) writeonly buffer VelocityOut { vec4 next_velocity[]; };

layout(location = 0) uniform uint active_count;
layout(location = 1) uniform float dt_s;       // drift: how long u moves on
layout(location = 2) uniform float kick_s;     // kick: dt_s, or half of it in the first substep
layout(location = 3) uniform vec3 gravity;     // m/s2

#ifdef TOOLS
layout(location = 4) uniform uint slot_count;
layout(std140, binding = kBindToolMotions) uniform ToolMotionsBlock { ToolMotion tool_motions[kMaxStyluses]; };
layout(std430, binding = kBindGrabOffsets) readonly buffer GrabOffsetsBuffer { vec4 grab_offsets[]; };
layout(std430, binding = kBindImpulses) buffer ImpulsesBuffer { vec4 impulses[]; };
#include "contact.glsl"
#endif

/// Sum of the spring (and dashpot) forces on a node [N].
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
      float k = float(count) * (spring < kAxialSprings ? body.axial_quarter_n_per_m : body.diagonal_half_n_per_m); \
      float l0 = spring < kAxialSprings ? h : kSqrt2 * h;                                       \
      uint n = neighborSlot(slot, offset);                                                      \
      Spring s = springBetween(h * vec3(offset), l0, texelFetch(displacement, int(n)).xyz - u);                  \
      force += (k * s.extension) * s.direction;                                                 \
      DASHPOT_FORCE(k, n, s)                                                                    \
    }                                                                                           \
  }
  FOR_EACH_SPRING(ADD_SPRING)
  return force;
}

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  vec3 u = texelFetch(displacement, int(slot)).xyz;
  bool held = (bits.lo & kGrabMask) != 0u;
  if ((bits.lo & kFixedBit) != 0u || (isIsolated(bits) && !held)) {  // a lone node sleeps; it would fall for ever
    next_displacement[slot] = vec4(u, 0.0);
    next_velocity[slot] = vec4(0.0);
    return;
  }
  BodyParams body = bodies[bodyOf(bits)];
  vec3 v = texelFetch(velocity, int(slot)).xyz;
  float mass = float((bits.lo >> kMassShift) & 15u) * body.mass_eighth_kg;
  vec3 acceleration = latticeForce(slot, bits, body, u, v) / mass + gravity;

  float g = 0.5 * body.drag_per_s * kick_s;
  vec3 v_next = ((1.0 - g) * v + kick_s * acceleration) / (1.0 + g);
  vec3 u_next = u + dt_s * v_next;
#ifdef TOOLS
  resolveContacts(slot, bits, mass, u, u_next, v_next);
#endif
  next_displacement[slot] = vec4(u_next, 0.0);
  next_velocity[slot] = vec4(v_next, 0.0);
}
