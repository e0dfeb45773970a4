// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// environment.comp - external effects on nodes, after an integrator's substep.   physics.md 8
// Owner: solver/gpu/contact/environment_pass.h
// in  displacement, velocity [slots] after the integrator; displacement before it in the output buffer
// out displacement, velocity [slots]
// Features: WIND, BODY_FORCES, OBSTACLES, COLLISIONS (corrections of collision_push.comp), TOOLS (there are styluses). BEFORE:
// runs before the integrator, which uses only the velocities (implicit Euler; its solution includes obstacles).
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/collision/environment.glsl"
#include "solver/tissue/sleep.glsl"

#ifndef __cplusplus
uniform uint obstacle_count;
uniform uint slot_count;
uniform vec4 air;  // xyz wind [m/s]; w density times drag coefficient over 2 [kg/m3]
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementOut) buffer DisplacementOut { vec4 next_displacement[]; };
layout(std430, binding = kBindVelocityOut) writeonly buffer VelocityOut { vec4 next_velocity[]; };
#ifdef BODY_FORCES
layout(std140, binding = kBindBodyInfluences) uniform BodyInfluencesBlock { vec4 body_influences[kMaxBodies]; };  // xyz m/s2
#endif
#ifdef OBSTACLES
layout(std140, binding = kBindObstacles) uniform ObstaclesBlock { ObstacleMotion obstacles[kMaxObstacles]; };
layout(std430, binding = kBindObstacleImpulses) buffer ObstacleImpulsesBuffer { vec4 obstacle_impulses[]; };
void giveObstacle(uint obstacle, uint slot, vec3 impulse) { obstacle_impulses[obstacle * slot_count + slot] += vec4(impulse, 1.0f); }
#endif
#ifdef COLLISIONS
layout(std430, binding = kBindCorrections) readonly buffer CorrectionsBuffer { vec4 corrections[]; };
#endif
#ifdef TOOLS
layout(std430, binding = kBindImpulses) buffer ImpulsesBuffer { vec4 impulses[]; };
void giveMomentum(uint stylus, uint slot, vec3 impulse) { impulses[stylus * slot_count + slot] += vec4(impulse, 1.0f); }
#endif
#ifdef WIND
layout(std430, binding = kBindWindStarts) readonly buffer RingStartsBuffer { uint ring_starts[]; };
layout(std430, binding = kBindWindTriangles) readonly buffer RingsBuffer { WindTriangle rings[]; };
layout(std430, binding = kBindSpringCut) readonly buffer SpringCutBuffer { float spring_cut[]; };
#endif
#endif

#ifdef WIND
bool isTorn(WindTriangle t) {
  for (int e = 0; e < 3; ++e) {
    if (t.springs[e] != kNoSpring && spring_cut[t.springs[e]] > 0.0f) return true;
  }
  return false;
}

/// Returns a third of the area of the triangles around a node, as normal times area [m2].
vec3 areaOf(uint slot, vec3 u) {
  vec3 sum = vec3(0.0f), rest = restPosition(slot);
  for (uint i = ring_starts[slot]; i < ring_starts[slot + 1u]; ++i) {
    WindTriangle t = rings[i];
    if (isTorn(t)) continue;
    vec3 b = (restPosition(t.b) - rest) + (xyz(stateAt(displacement, int(t.b))) - u);
    vec3 c = (restPosition(t.c) - rest) + (xyz(stateAt(displacement, int(t.c))) - u);
    sum += cross(b, c);
  }
  return sum / 6.0f;
}
#endif

/// Returns the change of a node's velocity by contacts [m/s].
vec3 contactKick(uint slot) {
#ifdef COLLISIONS
  return xyz(corrections[2u * slot]);
#else
  return vec3(0.0f);
#endif
}

/// Returns the change of its velocity by force_n and wind [m/s].
vec3 pushKick(uint slot, NodeBits bits, vec3 u, vec3 v) {
  vec3 kick = vec3(0.0f);
#ifdef BODY_FORCES
  kick += dt_s * xyz(body_influences[bodyOf(bits)]);
#endif
#ifdef WIND
  if (ring_starts[slot] != ring_starts[slot + 1u]) {
    kick += windKick(areaOf(slot, u), air, v, nodeMass(slot, bits, bodies[bodyOf(bits)]));
  }
#endif
  return kick;
}

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  vec3 u = xyz(stateAt(displacement, int(slot))), v = xyz(stateAt(velocity, int(slot)));
  bool lone = isIsolated(bits);
  if (lone || (bits.lo & (kFixedBit | kGrabMask)) != 0u) {
    next_displacement[slot] = vec4(u, 0.0f);
    next_velocity[slot] = vec4(v, 0.0f);
#ifdef TOOLS
    uint held_by = (bits.lo & kGrabMask) >> kGrabShift;
    if (lone || held_by == 0u || (bits.lo & kFixedBit) != 0u) return;
    vec3 kick = contactKick(slot) + pushKick(slot, bits, u, v);
    if (kick != vec3(0.0f)) giveMomentum(held_by - 1u, slot, -nodeMass(slot, bits, bodies[bodyOf(bits)]) * kick);
#endif
    return;
  }
  vec3 u_next = u, v_next = v;
#ifdef COLLISIONS
  vec3 contact_kick = contactKick(slot);
  v_next += contact_kick;
  u_next += dt_s * contact_kick + xyz(corrections[2u * slot + 1u]);
#endif
#if defined(WIND) || defined(BODY_FORCES)
  vec3 kick = pushKick(slot, bits, u, v_next);
  v_next += kick;
#ifdef BEFORE
  next_displacement[slot] = vec4(u, 0.0f);
  next_velocity[slot] = vec4(v_next, 0.0f);
  return;
#endif
  u_next += dt_s * kick;
#endif
  vec3 u_before = xyz(next_displacement[slot]);
#ifdef OBSTACLES
  vec3 rest = restPosition(slot);
  vec3 x = rest + u_before, x_next = rest + u_next;
  bool touched = false;
  float below = surfaceDepth(slot);
  for (uint o = 0u; o < obstacle_count; ++o) {
    vec3 v_free = v_next;
    if (!meetObstacle(seenFrom(below, obstacles[o]), x, x_next, v_next)) continue;
    touched = true;
    if (v_next == v_free) continue;
    // The kick before included drag: of the obstacle's momentum only 1 / (1 + gamma dt / 2) arrived.
    BodyParams body = bodies[bodyOf(bits)];
    giveObstacle(o, slot, (1.0f + 0.5f * body.mass_damping_per_s * dt_s) * nodeMass(slot, bits, body) * (v_next - v_free));
  }
  if (touched) u_next = x_next - rest;
#endif
  fallAsleep(bits, u_before, u_next, v_next);  // or external effects would move nodes that the integrator has stopped
  next_displacement[slot] = vec4(u_next, 0.0f);
  next_velocity[slot] = vec4(v_next, 0.0f);
}
