// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Probes and obstacles in the solution of a substep of implicit Euler (physics.md 2): nodes in contact. After implicit.glsl.
// Features: CONTACT, with TOOLS (probes), OBSTACLES.
// A node that a sweep would leave in a probe or an obstacle gets a contact with it: the half space outside its surface, as seen
// from the node's position before the substep, in which the node must end. So only which contacts exist depends on the sweeps,
// not the contacts themselves. The contact force keeps the node there: it pushes, with friction up to Coulomb's limit.
#include "solver/tools/touch.glsl"
#ifdef TOOLS
#include "solver/tools/contact.glsl"
#endif

#ifndef __cplusplus
layout(std430, binding = kBindNodeContacts) buffer NodeContactsBuffer { vec4 node_contacts[]; };
uniform uint contact_rows;  // number of contacts that a node may have at once
#ifndef TOOLS
uniform float push_speed;
uniform uint slot_count;
#endif
#ifdef OBSTACLES
uniform uint obstacle_count;
uniform float resting_speed;
layout(std140, binding = kBindObstacles) uniform ObstaclesBlock { ObstacleMotion obstacles[kMaxObstacles]; };
layout(std430, binding = kBindObstacleImpulses) buffer ObstacleImpulsesBuffer { vec4 obstacle_impulses[]; };
void giveObstacle(uint obstacle, uint slot, vec3 impulse) { obstacle_impulses[obstacle * slot_count + slot] += vec4(impulse, 1.0f); }
#endif
#endif

/// n . du >= least, with the motion and friction of the surface.
struct Contact {
  vec3 normal;
  float least;     // [m]
  vec3 offset;     // displacement of the surface in the substep [m]
  float friction;
  vec3 force;      // on the node, in the last solution [N]
  float owner;     // 1 + stylus, or 1 + kMaxStyluses + obstacle; 0: no contact in this row or later ones
};
uint contactAt(uint slot, uint row) { return 3u * (slot * contact_rows + row); }

Contact contactOf(uint slot, uint row) {
  uint at = contactAt(slot, row);
  vec4 plane = node_contacts[at], surface = node_contacts[at + 1u], force = node_contacts[at + 2u];
  Contact c = {xyz(plane), plane.w, xyz(surface), surface.w, xyz(force), force.w};
  return c;
}

uint contactCount(uint slot) {
  uint count = 0u;
  while (count < contact_rows && node_contacts[contactAt(slot, count) + 2u].w != 0.0f) ++count;
  return count;
}

void clearContacts(uint slot) {
  for (uint row = 0u; row < contact_rows; ++row) node_contacts[contactAt(slot, row) + 2u] = vec4(0.0f);
}

/// @param side  xyz normal; w depth of the node inside [m]: beyond the surface's own motion it leaves no faster than waves travel
void addContact(uint slot, float owner, vec4 side, vec3 offset, float friction) {
  for (uint row = 0u; row < contact_rows; ++row) {
    uint at = contactAt(slot, row);
    float owned_by = node_contacts[at + 2u].w;
    if (owned_by == owner) return;
    if (owned_by != 0.0f) continue;
    float most = push_speed * dt_s + max(0.0f, dot(offset, xyz(side)));
    node_contacts[at] = vec4(xyz(side), min(side.w, most));
    node_contacts[at + 1u] = vec4(offset, friction);
    node_contacts[at + 2u] = vec4(0.0f, 0.0f, 0.0f, owner);
    return;
  }
}

#ifdef TOOLS
/// Gives a node a contact with a probe or a shaft in which it would end. With both of one stylus it has the first contact alone.
void findSphere(uint slot, float owner, ToolMotion motion, vec3 x, vec3 x_next, float below) {
  vec3 travel = xyz(motion.to) - xyz(motion.from);
  if (distance(x_next, xyz(motion.to)) >= max(motion.from.w + below, 0.0f) + length(travel)) return;
  if (!sideOfProbe(motion, x, x_next, below).inside) return;
  ProbeSide side = sideOfProbe(motion, x, x, below);
  addContact(slot, owner, vec4(side.normal, side.depth), travel, 0.0f);
}
#endif

/// Gives a node a contact with everything in which an increment would end.
void findContacts(uint slot, vec3 u, vec3 du) {
  vec3 x = restPosition(slot) + u, x_next = x + du;
  float below = surfaceDepth(slot);
#ifdef TOOLS
  for (uint s = 0u; s < kMaxStyluses; ++s) {
    if (pushesByTip(tool_motions[s])) findSphere(slot, float(1u + s), tool_motions[s], x, x_next, below);
#ifdef SHAFTS
    if (pushesByShaft(tool_motions[s])) findSphere(slot, float(1u + s), shaftNear(tool_motions[s], x_next), x, x_next, below);
#endif
  }
#endif
#ifdef OBSTACLES
  for (uint o = 0u; o < obstacle_count; ++o) {
    ObstacleMotion seen = seenFrom(below, obstacles[o]);
    Meeting meeting = meetingOf(seen, x, x_next);
    if (!meeting.touches) continue;
    addContact(slot, float(1u + kMaxStyluses + o), outsideOf(seen, meeting, x, x_next), motionOfSurface(obstacles[o], x, dt_s),
               obstacles[o].velocity.w);
  }
#endif
}

/// Returns the nearest increment that a node's contacts allow; between opposite contacts a compromise.
vec3 outside(uint slot, vec3 du) {
  const uint rounds = 4u;
  uint count = contactCount(slot);
  for (uint i = 0u; i < rounds * count; ++i) {
    vec4 plane = node_contacts[contactAt(slot, i % count)];
    du += max(0.0f, plane.w - dot(xyz(plane), du)) * xyz(plane);
  }
  return du;
}

/// Returns the compliance along a direction [m/N].
float givesAlong(vec3 direction, float stiffness_n_per_m) { return dot(direction, direction / stiffness_n_per_m); }

/// Returns the force of a contact on a node that moves by (force + that) / stiffness [N]. Without friction it is the smallest
/// push that keeps the node outside. With friction it is the force of the last solution, corrected tangentially by the slip, up
/// to Coulomb's limit.
vec3 forceOfContact(Contact c, float stiffness_n_per_m, vec3 du, vec3 force) {
  const int rounds = 6;
  float give = givesAlong(c.normal, stiffness_n_per_m);
  if (c.friction == 0.0f) {
    float missing = c.least - dot(c.normal, du + force / stiffness_n_per_m);
    return (max(0.0f, missing) / give) * c.normal;
  }
  vec3 across = normalize(cross(c.normal, abs(c.normal.x) < 0.7f ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 1.0f, 0.0f)));
  float slip_gives = max(givesAlong(across, stiffness_n_per_m), givesAlong(cross(c.normal, across), stiffness_n_per_m));
  vec3 own = c.force;
  for (int i = 0; i < rounds; ++i) {
    vec3 next = du + (force + own) / stiffness_n_per_m;
    float pressure = max(0.0f, dot(own, c.normal) + (c.least - dot(c.normal, next)) / give);
    vec3 drag = own - (next - c.offset) / slip_gives;
    drag -= dot(drag, c.normal) * c.normal;
    float size = length(drag), most = c.friction * pressure;
    own = pressure * c.normal + (size > most ? most / size : 1.0f) * drag;
  }
  return own;
}

/// Returns the step of a node with contacts: the minimum of stiffness s s / 2 - force s under its contacts, found contact by
/// contact. Stores the forces of the contacts for this step.
vec3 stepInContact(uint slot, float stiffness_n_per_m, vec3 du, vec3 force) {
  const uint rounds = 8u;
  uint count = contactCount(slot);
  vec3 forces[kMostContacts], total = force;
  for (uint row = 0u; row < count; ++row) {
    forces[row] = xyz(node_contacts[contactAt(slot, row) + 2u]);
    total += forces[row];
  }
  for (uint i = 0u; i < (count > 1u ? rounds * count : count); ++i) {
    uint row = i % count;
    vec3 others = count > 1u ? total - forces[row] : force;
    forces[row] = forceOfContact(contactOf(slot, row), stiffness_n_per_m, du, others);
    total = others + forces[row];
  }
  for (uint row = 0u; row < count; ++row) {
    uint at = contactAt(slot, row) + 2u;
    node_contacts[at] = vec4(forces[row], node_contacts[at].w);
  }
  return outside(slot, du + total / stiffness_n_per_m) - du;  // exact to rounding
}

/// Returns the friction term of P for an increment, with the pressure of the last solution [J].
float frictionOf(uint slot, vec3 du) {
  float sum = 0.0f;
  uint count = contactCount(slot);
  for (uint row = 0u; row < count; ++row) {
    Contact c = contactOf(slot, row);
    vec3 slip = du - c.offset;
    sum += c.friction * max(0.0f, dot(c.force, c.normal)) * length(slip - dot(slip, c.normal) * c.normal);
  }
  return sum;
}
