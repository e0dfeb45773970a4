// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// leapfrog.comp - advance every active node by one leapfrog substep.   Owner: solver/gpu/steps/leapfrog_pass.h   physics.md 2, 5
// in  displacement, velocity [slots]     out  displacement, velocity [slots]; impulses [kMaxStyluses * slots]; nodes for edges.comp
// Features: LATTICE, NETWORK, PARTS, LAW (elastic.glsl), NO_SPRINGS (all bodies obey a law), DASHPOT (axial dashpot), PREDICTED
// (mild springs of lattices act at the predicted positions of their ends instead), TOOLS (probe and held nodes), COMPENSATED
// (Kahan's sums of u and v), AWAKE (only nodes of awake bricks, as listed by awake_bricks.comp).
#ifdef LOADS
#define DEAD_LINKS
#endif
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"

#ifndef __cplusplus
#ifdef AWAKE
layout(std430, binding = kBindAwakeNodes) readonly buffer AwakeNodesBuffer {
  uvec3 node_groups;
  uint active_count;
  uvec4 node_counts;
  uint active_nodes[];
};
#else
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
#endif
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementOut) writeonly buffer DisplacementOut { vec4 next_displacement[]; };
layout(std430, binding = kBindVelocityOut) writeonly buffer VelocityOut { vec4 next_velocity[]; };
#ifdef COMPENSATED
layout(std430, binding = kBindCompensation) buffer CompensationBuffer { vec4 compensation[]; };
#endif
#endif

#include "solver/tissue/step.glsl"
#ifdef TOOLS
#include "solver/tools/contact.glsl"
#include "solver/tools/skin.glsl"
layout(std430, binding = kBindEdgeNodes) buffer EdgeNodesBuffer {
  uint edge_count;
  uint edge_nodes[kMostEdgeNodes];
};
#endif

/// Returns the sum of the forces of springs, dashpots and cells on a node [N].
vec3 elasticForce(uint slot, NodeBits bits, BodyParams body, vec3 u, vec3 v) {
  vec3 force = vec3(0.0f);
#ifdef DASHPOT
#define DASHPOT_FORCE(k, n, s) force += (k * body.dashpot_s * dot(xyz(stateAt(velocity, int(n))) - v, s.direction)) * s.direction;
#else
#define DASHPOT_FORCE(k, n, s)
#endif
#ifdef PREDICTED
#define VISIT_LINK                                                                                \
  vec3 w = xyz(stateAt(displacement, int(n))) - u, dv = xyz(stateAt(velocity, int(n))) - v;       \
  precise vec3 soon = w + body.dashpot_s * dv;                                                    \
  bool mild = body.connections == kImplicit && isMild(d, l0, soon);                               \
  Spring s = springBetween(d, l0, prestrain, mild ? soon : w);                                    \
  force += (k * (s.extension + (mild ? 0.0f : body.dashpot_s * dot(dv, s.direction)))) * s.direction;
#else
#define VISIT_LINK                                                                  \
  Spring s = springBetween(d, l0, prestrain, xyz(stateAt(displacement, int(n))) - u); \
  force += (k * s.extension) * s.direction;                                         \
  DASHPOT_FORCE(k, n, s)
#endif
#ifndef NO_SPRINGS
#ifdef LAW
  if (body.law == kLawSprings) {
    FOR_EACH_LINK
  }
#else
  FOR_EACH_LINK
#endif
#endif
#undef VISIT_LINK
#ifdef LAW
  force += cellForce(slot);
#ifdef WALLS
  force += rowForce(slot, bits);
#endif
#endif
  return force;
}

/// Returns sum + increment, by Kahan: adds the rounding error of the last sums first, and stores that of this one. @param of
/// compensation's index
vec3 added(uint of, vec3 sum, vec3 increment) {
#ifdef COMPENSATED
  precise vec3 all_of_it = increment - xyz(compensation[of]);
  precise vec3 next = sum + all_of_it;
  precise vec3 lost = (next - sum) - all_of_it;
  compensation[of] = vec4(lost, 0.0f);
  return next;
#else
  return sum + increment;
#endif
}

/// Advances a node: ((1 - g) v + kick a) / (1 + g), as v and an increment. Rounding of 1 - g would act as drag, the same in every
/// substep.
void advance(uint slot, BodyParams body, vec3 acceleration, vec3 u, vec3 v, OUT(vec3) u_next, OUT(vec3) v_next) {
  float g = 0.5f * body.mass_damping_per_s * kick_s;
  v_next = added(2u * slot + 1u, v, (kick_s * acceleration - (2.0f * g) * v) / (1.0f + g));
  u_next = added(2u * slot, u, dt_s * v_next);
}

#ifdef WALLS
/// Advances a ghost: only the second difference of its fixed node acts on it.
void stepGhost(uint slot, NodeBits bits) {
  uint spring = (bits.lo >> kGhostRowShift) & 7u, axis = spring >> 1;
  uint fixed_node = besideInRow(slot, axis, (spring & 1u) == 0u ? 1 : -1);
  NodeBits of_fixed = nodes[fixed_node];
  vec3 u = xyz(stateAt(displacement, int(slot))), u_next = u, v_next = vec3(0.0f);
  if (isWithinRow(of_fixed, axis)) {
    BodyParams body = bodies[bodyOf(bits)];
    vec3 force = -xyz(stateAt(cell_forces, int(cellVector(fixed_node, kCellVectors + axis))));
    advance(slot, body, force / nodeMass(fixed_node, of_fixed, body), u, xyz(stateAt(velocity, int(slot))), u_next, v_next);
    fallAsleep(bits, u, u_next, v_next);
  }
  next_displacement[slot] = vec4(u_next, 0.0f);
  next_velocity[slot] = vec4(v_next, 0.0f);
}
#endif

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
#ifdef WALLS
  if (isGhost(bits)) {
    stepGhost(slot, bits);
    return;
  }
#endif
  vec3 u = xyz(stateAt(displacement, int(slot)));
  if (isAtRest(bits)) {
    next_displacement[slot] = vec4(u, 0.0f);
    next_velocity[slot] = vec4(0.0f);
    return;
  }
  BodyParams body = bodies[bodyOf(bits)];
  vec3 v = xyz(stateAt(velocity, int(slot)));
  float mass = nodeMass(slot, bits, body);
  vec3 acceleration = elasticForce(slot, bits, body, u, v) / mass + gravity;
  vec3 u_next, v_next;
  advance(slot, body, acceleration, u, v, u_next, v_next);
#ifdef TOOLS
  resolveContacts(slot, bits, mass, u, u_next, v_next);
  if (mayFeelEdges(slot, bits, restPosition(slot) + u_next)) {
    uint position = atomicAdd(edge_count, 1u);
    if (position < kMostEdgeNodes) edge_nodes[position] = slot;
  }
#endif
  fallAsleep(bits, u, u_next, v_next);
  next_displacement[slot] = vec4(u_next, 0.0f);
  next_velocity[slot] = vec4(v_next, 0.0f);
}
