// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Implicit Euler in increments du = u+ - u, the equations that pd solves (physics.md 2). After elastic.glsl and step.glsl.
//   m (1 + gamma dt)/dt^2 (du - y) = F(u + du),   y = (dt v + dt^2 g)/(1 + gamma dt),   v+ = du/dt
// F includes the springs and the dashpots c/dt n n^T (du_far - du_near), n at the current iterate. A solution is a stationary
// point of the incremental potential
//   P(du) = sum of m (1 + gamma dt)/(2 dt^2) |du - y|^2 + E(u + du) + sum of c/(2 dt) (n . (du_far - du_near))^2
// increment.w is 1 where du is prescribed (fixed, sleeping and held nodes), -1 where the node has contacts
// (implicit_contact.glsl), -2 where it may touch other nodes (implicit_pairs.glsl).
#ifndef __cplusplus
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
// Word 0: float bits of the share of y from which the iterations start; at the end, of the share of du that was taken. Then two
// words per iteration of pd: float bits of its largest change; 1 if acceleration was abandoned by then.
layout(std430, binding = kBindGuard) buffer GuardBuffer { uint guard[]; };
#endif

uint changeWord(uint iteration) { return 1u + 2u * iteration; }
uint plainWord(uint iteration) { return 2u + 2u * iteration; }

bool isPrescribed(vec4 du) { return du.w > 0.0f; }
bool isInContact(vec4 du) { return du.w < 0.0f; }
bool isInPairs(vec4 du) { return du.w < -1.5f; }

/// Returns m (1 + gamma dt)/dt^2 [N/m].
float inertia(float mass, BodyParams body) { return mass * (1.0f + body.mass_damping_per_s * dt_s) / (dt_s * dt_s); }

/// Returns y, the increment without any force.
vec3 freeIncrement(uint slot, BodyParams body) {
  vec3 v = xyz(stateAt(velocity, int(slot)));
  return (dt_s * v + (dt_s * dt_s) * gravity) / (1.0f + body.mass_damping_per_s * dt_s);
}

/// Returns c/dt of a spring's dashpot [N/m].
float damping(float k, BodyParams body) {
#ifdef DASHPOT
  return k * body.dashpot_s / dt_s;
#else
  return 0.0f;
#endif
}

/// State of a spring in the current iterate, as seen from one end.
struct ImplicitSpring {
  Spring spring;
  float damping;  // c/dt [N/m]
  vec3 force;     // spring and dashpot [N]
};

/// @param u, du  of the near end   @param n, d, l0, prestrain, k  as in FOR_EACH_LINK (elastic.glsl)
ImplicitSpring implicitSpring(uint n, vec3 u, vec3 du, vec3 d, float l0, float prestrain, float k, BodyParams body) {
  vec3 along = xyz(stateAt(increment, int(n))) - du;
  ImplicitSpring s;
  s.spring = springBetween(d, l0, prestrain, (xyz(stateAt(displacement, int(n))) - u) + along);
  s.damping = damping(k, body);
  s.force = (k * s.spring.extension + s.damping * dot(s.spring.direction, along)) * s.spring.direction;
  return s;
}

