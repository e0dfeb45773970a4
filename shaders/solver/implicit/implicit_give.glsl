// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// End of an implicit substep: impulses of contacts, and probes that only feel (physics.md 2, 5). After implicit_contact.glsl.
// Features: CONTACT, TOOLS, OBSTACLES.
#ifdef CONTACT
#ifdef OBSTACLES
/// Bounces a fast impact: its approach along the normal is reversed by the restitution. The bounce is at most the velocity that
/// the substep removed, as its inelastic end dissipated the square of all of it. @return  change of velocity [m/s]
vec3 bounceOf(Contact c, float restitution, vec3 v_before, vec3 v_next) {
  vec3 surface = c.offset / dt_s;
  float approach = -dot(v_before - surface, c.normal);
  if (approach <= resting_speed) return vec3(0.0f);
  return max(0.0f, restitution * approach - dot(v_next - surface, c.normal)) * c.normal;
}
#endif

/// Adds the impulses on a node to those of probes and obstacles.
void giveContacts(uint slot, float mass, INOUT(vec3) v_next) {
  vec3 v_before = xyz(stateAt(velocity, int(slot)));
  uint count = contactCount(slot);
  for (uint row = 0u; row < count; ++row) {
    Contact c = contactOf(slot, row);
    if (c.force == vec3(0.0f)) continue;
    uint owner = uint(c.owner) - 1u;
#ifdef TOOLS
    if (owner < kMaxStyluses) giveMomentum(owner, slot, dt_s * c.force);
#endif
#ifdef OBSTACLES
    if (owner < kMaxStyluses) continue;
    uint obstacle = owner - kMaxStyluses;
    vec3 bounce = bounceOf(c, obstacles[obstacle].spin.w, v_before, v_next);
    v_next += bounce;
    giveObstacle(obstacle, slot, dt_s * c.force + mass * bounce);
#endif
  }
}
#endif

#ifdef TOOLS
/// Counts the nodes with tissue within reach of a probe or a shaft that only feels.
void feel(uint slot, vec3 x) {
  for (uint s = 0u; s < kMaxStyluses; ++s) {
    ToolMotion motion = tool_motions[s];
    if ((motion.info.y & kToolFeels) == 0u) continue;
    if ((motion.info.y & kToolPushes) != 0u && isFelt(motion, slot, surfaceDepth(slot), x)) giveMomentum(s, slot, vec3(0.0f));
#ifdef SHAFTS
    if ((motion.info.y & kToolShaft) != 0u && isFelt(shaftNear(motion, x), slot, surfaceDepth(slot), x)) giveMomentum(s, slot, vec3(0.0f));
#endif
  }
}
#endif
