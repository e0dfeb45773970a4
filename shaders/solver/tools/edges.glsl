// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Contact of a probe or a shaft with springs on the surface between their ends (physics.md 5). After skin.glsl; reads and changes the state
// at the end of a substep, next_displacement and next_velocity.

/// A probe or a shaft at the end of a substep.
struct EdgeTip {
  vec3 at;            // centre of the probe, near end of the shaft's axis [m]
  ToolMotion motion;  // relative to it, so positions far from the origin do not lose digits; has kToolShaft of a shaft alone
};

#ifdef SHAFTS
EdgeTip shaftOf(ToolMotion motion) {
  EdgeTip tip = {xyz(motion.shaft_to), motion};
  vec3 from = xyz(motion.shaft_from) - tip.at, far_from = xyz(motion.shaft_far_from) - tip.at;
  vec3 far_to = xyz(motion.shaft_far_to) - tip.at;
  tip.motion.shaft_from.x = from.x;
  tip.motion.shaft_from.y = from.y;
  tip.motion.shaft_from.z = from.z;
  tip.motion.shaft_to.x = tip.motion.shaft_to.y = tip.motion.shaft_to.z = 0.0f;
  tip.motion.shaft_far_from.x = far_from.x;
  tip.motion.shaft_far_from.y = far_from.y;
  tip.motion.shaft_far_from.z = far_from.z;
  tip.motion.shaft_far_to.x = far_to.x;
  tip.motion.shaft_far_to.y = far_to.y;
  tip.motion.shaft_far_to.z = far_to.z;
  return tip;
}

/// Returns the part of a spring's squared length that is across a shaft; 0 for one along it, which only its nodes meet.
float lengthAcross2(ToolMotion shaft, vec3 along) {
  const float least = 1e-3f;  // sin^2 of the angle between them: at smaller angles the point nearest to the axis is not definite
  vec3 across = cross(along, normalize(xyz(shaft.shaft_far_to)));
  float across2 = dot(across, across);
  return across2 > least * dot(along, along) ? across2 : 0.0f;
}

/// Returns where the axis of a shaft is nearest to the line through x along a spring, 0 to 1. @param across2  lengthAcross2()
float alongNearLine(ToolMotion shaft, vec3 x, vec3 along, float across2) {
  vec3 axis = xyz(shaft.shaft_far_to);
  float length2 = dot(along, along);
  vec3 beside = x - (dot(x, along) / length2) * along;
  return clamp(dot(beside, axis) * length2 / (across2 * dot(axis, axis)), 0.0f, 1.0f);
}
#endif

EdgeTip tipOf(ToolMotion motion) {
  EdgeTip tip = {xyz(motion.to), motion};
  tip.motion.info.y &= ~kToolShaft;
  tip.motion.from.x -= motion.to.x;
  tip.motion.from.y -= motion.to.y;
  tip.motion.from.z -= motion.to.z;
  tip.motion.to.x = tip.motion.to.y = tip.motion.to.z = 0.0f;
  return tip;
}

/// Returns the position of a node at the end of the substep, relative to EdgeTip::at [m].
vec3 seenFromTip(EdgeTip tip, uint slot) {
  precise vec3 rest = restPosition(slot) - tip.at;
  return rest + xyz(next_displacement[slot]);
}

/// Returns the sagitta at a point of a chord of a surface that follows a wide sphere [m]; 0 for a sphere not wider than the chord
/// is long, which a lattice's surface cannot follow.
float chordWithin(float radius, float length2, float share) {
  float wider = 1.0f - sqrt(length2) / max(radius, 1e-9f);
  return wider > 0.0f ? wider * share * (1.0f - share) * length2 / (2.0f * radius) : 0.0f;
}

/// Correction that a probe or a shaft demands of the point of a spring nearest to its centre or axis.
struct EdgeShift {
  vec2 shift;         // out of the probe: of its position [m] and its velocity [m/s]; 0: none
  vec3 normal;
  float near, share;  // weights of the node and of the other end in the point
};

/// Returns the correction of a spring. @param n  node at the other end of the spring
EdgeShift shiftOfEdge(EdgeTip tip, uint slot, uint n) {
  vec3 x = seenFromTip(tip, slot), along = seenFromTip(tip, n) - x;
  float length2 = dot(along, along), chord2 = length2;
  EdgeShift none = {vec2(0.0f), vec3(0.0f), 1.0f, 0.0f};
  ToolMotion sphere = tip.motion;
#ifdef SHAFTS
  if ((sphere.info.y & kToolShaft) != 0u) {
    chord2 = lengthAcross2(sphere, along);
    if (chord2 == 0.0f) return none;
    sphere = sphereOfShaft(sphere, alongNearLine(sphere, x, along, chord2));
  }
#endif
  float on_edge = dot(xyz(sphere.to) - x, along);
  if (on_edge <= 0.0f || on_edge >= length2) return none;  // a node is nearest
  float share = on_edge / length2;
  vec3 point = x + share * along;
  float below = surfaceDepth(slot);
  below += share * (surfaceDepth(n) - below);
  ProbeSide side = sideOfProbe(sphere, point, point, below - chordWithin(sphere.from.w + below, chord2, share));
  vec3 v = xyz(next_velocity[slot]);
  v += share * (xyz(next_velocity[n]) - v);
  float approach = dot(v - (xyz(sphere.to) - xyz(sphere.from)) / dt_s, side.normal);
  float slowest = min(side.depth, 0.0f) / dt_s;  // a point outside may come as far as the surface
  EdgeShift it = {vec2(clamp(side.depth, 0.0f, push_speed * dt_s), max(slowest - approach, 0.0f)), side.normal, 1.0f - share, share};
  return it;
}

/// A node's mass is divided among the points that need a correction, by its weight in each times their displacement: a point that
/// is barely touched changes nothing. A point is moved by an impulse along the normal, which moves both ends by their weights
/// over the masses available for it: m_i w_i d / s_i, with s_i the sum of w d over all points at that end. So the forces on the
/// ends are in the ratio of their weights, and no impulse is tangential to the probe's surface.
struct EdgePush {
  vec3 x, v;  // change of a node's position [m] and velocity [m/s]
};

/// @param give  1/mass of the node and of the other end [1/kg]
void addEdge(EdgeShift it, vec2 give, vec2 sums, vec2 far_sums, INOUT(EdgePush) push) {
  const float least = 1e-30f;  // far below any displacement: avoids a division by 0
  vec2 part = it.near * give.x * it.shift * it.shift / max(it.near * give.x * sums + it.share * give.y * far_sums, vec2(least));
  push.x += part.x * it.normal;
  push.v += part.y * it.normal;
}

float massAt(uint slot) {
  NodeBits bits = nodes[slot];
  return nodeMass(slot, bits, bodies[bodyOf(bits)]);
}

// FOR_EACH_EDGE executes VISIT_EDGE(n) for the other ends n of all surface springs of the node `slot` with `bits` and `body`.
#define SPRING_EDGE(spring, offset)                  \
  if (springCount(bits, spring) != 0u) {             \
    uint n = neighborSlot(slot, offset);             \
    if (onSkin(n, nodes[n])) VISIT_EDGE(n)           \
  }
#define LINK_EDGES                                                               \
  FOR_EACH_LINK_INDEX(link) {                                                    \
    Link it = linkAt(link);                                                      \
    bool spans_two = (it.lattice_spring & kLatticeSpringMask) == kBendingSpring; \
    if (it.stiffness != 0.0f && !spans_two) VISIT_EDGE(it.far)                   \
  }
#if defined(LATTICE) && defined(NETWORK)
#define FOR_EACH_EDGE                  \
  if (body.connections == kImplicit) { \
    FOR_EACH_SPRING(SPRING_EDGE)       \
  } else {                             \
    LINK_EDGES                         \
  }
#elif defined(NETWORK)
#define FOR_EACH_EDGE LINK_EDGES
#else
#define FOR_EACH_EDGE FOR_EACH_SPRING(SPRING_EDGE)
#endif

/// Moves a node by the corrections of its points.
void giveEdges(uint stylus, uint slot, EdgePush push) {
  if (push.x == vec3(0.0f) && push.v == vec3(0.0f)) return;
  next_displacement[slot] = vec4(xyz(next_displacement[slot]) + push.x, 0.0f);
  next_velocity[slot] = vec4(xyz(next_velocity[slot]) + push.v, 0.0f);
  giveMomentum(stylus, slot, massAt(slot) * push.v);
}
