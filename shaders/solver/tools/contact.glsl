// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Effect of a probe or a shaft on a node, and the position of a held node (VR05 2.7.1, 2.7.2; physics.md 5). Included by the integrators.
#include "solver/tissue/surface_offset.glsl"
#include "solver/tools/touch.glsl"

#ifndef __cplusplus
layout(std140, binding = kBindToolMotions) uniform ToolMotionsBlock { ToolMotion tool_motions[kMaxStyluses]; };
layout(std430, binding = kBindGrabOffsets) readonly buffer GrabOffsetsBuffer { vec4 grab_offsets[]; };
layout(std430, binding = kBindImpulses) buffer ImpulsesBuffer { vec4 impulses[]; };

/// Adds an impulse to the sum of a stylus on this node in this tick; w counts substeps of contact.
void giveMomentum(uint stylus, uint slot, vec3 impulse) { impulses[stylus * slot_count + slot] += vec4(impulse, 1.0f); }
#endif

/// Applies a swept sphere. A node inside the final sphere moves to its surface along the radius. One that the sphere has passed
/// over moves out of the swept capsule sideways, so no sweep is too fast. Its normal velocity becomes the tool's.
/// @param below  surfaceDepth() of the node
void probe(ToolMotion motion, float below, vec3 x, INOUT(vec3) x_next, INOUT(vec3) v_next) {
  ProbeSide side = sideOfProbe(motion, x, x_next, below);
  if (!side.inside) return;
  vec3 travel = xyz(motion.to) - xyz(motion.from);
  // Out of the tool, but no faster than waves travel: a tool that appears inside the tissue must not eject it.
  x_next += min(side.depth, push_speed * dt_s) * side.normal;
  float approach = dot(v_next - travel / dt_s, side.normal);
  if (approach < 0.0f) v_next -= approach * side.normal;
}

/// Returns the displacement from a node to its tissue at the beginning of the substep [m].
vec3 toTissueBefore(uint slot) {
  uint offset = surfaceOffset(slot);
  if (offset == 0u) return vec3(0.0f);
  return toTissueIn(offset, bodies[bodyAt(slot)].origin_spacing.w, xyz(stateAt(displacement, int(slot))),
                    xyz(stateAt(displacement, int(pathEnd(slot, offset, 0u)))), xyz(stateAt(displacement, int(pathEnd(slot, offset, 1u)))),
                    xyz(stateAt(displacement, int(pathEnd(slot, offset, 2u)))));
}

/// Returns whether the tissue of a node is within reach of a probe or a shaft that only feels. A node in the air next to the tip does not
/// count: from there a tip may push.
/// @param below  surfaceDepth(): a positive depth adds to the reach   @param x  position of the node at the end of the substep
/// [m]
bool isFelt(ToolMotion motion, uint slot, float below, vec3 x) {
  float reach = motion.from.w + max(below, 0.0f) + distance(xyz(motion.from), xyz(motion.to));
  return distance(x + toTissueBefore(slot), xyz(motion.to)) < reach;
}

/// Returns the displacement at which a stylus holds a node at the end of the substep [m].
vec3 heldDisplacement(uint stylus, uint slot) {
  return xyz(tool_motions[stylus].to) + rotated(xyzw(tool_motions[stylus].orientation), xyz(grab_offsets[slot])) - restPosition(slot);
}

/// Applies the swept sphere of a probe or a shaft to a free node.
/// @param rest  position of the node at rest   @param u, u_next  displacement before and after the substep [m]
void meetSphere(uint stylus, ToolMotion motion, uint slot, float below, float mass, vec3 rest, vec3 u, INOUT(vec3) u_next,
                INOUT(vec3) v_next) {
  vec3 x_next = rest + u_next;
  if ((motion.info.y & kToolFeels) != 0u) {
    if (isFelt(motion, slot, below, x_next)) giveMomentum(stylus, slot, vec3(0.0f));
    return;
  }
  vec3 reach = x_next - xyz(motion.to);
  float far = max(motion.from.w + below, 0.0f) + distance(xyz(motion.from), xyz(motion.to));
  if (dot(reach, reach) >= far * far) return;
  vec3 v_before = v_next;
  probe(motion, below, rest + u, x_next, v_next);
  u_next = x_next - rest;
  if (v_next != v_before) giveMomentum(stylus, slot, mass * (v_next - v_before));
}

void resolveContacts(uint slot, NodeBits bits, float mass, vec3 u, INOUT(vec3) u_next, INOUT(vec3) v_next) {
  vec3 rest = restPosition(slot);
  float below = surfaceDepth(slot);
  uint held_by = (bits.lo & kGrabMask) >> kGrabShift;
  for (uint s = 0u; s < kMaxStyluses; ++s) {
    if (held_by == s + 1u) {
      vec3 v_before = v_next;
      u_next = heldDisplacement(s, slot);
      v_next = (u_next - u) / dt_s;
      giveMomentum(s, slot, mass * (v_next - v_before));
    }
    if (held_by != 0u) continue;
    if ((tool_motions[s].info.y & kToolPushes) != 0u) meetSphere(s, tool_motions[s], slot, below, mass, rest, u, u_next, v_next);
#ifdef SHAFTS
    if ((tool_motions[s].info.y & kToolShaft) != 0u)
      meetSphere(s, shaftNear(tool_motions[s], rest + u_next), slot, below, mass, rest, u, u_next, v_next);
#endif
  }
}
