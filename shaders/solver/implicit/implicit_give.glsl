// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// At the end of an implicit substep: what contacts gave, and who feels (physics.md 2, 5). After implicit_contact.glsl.
// Features: CONTACT, TOOLS, OBSTACLES.
#ifdef CONTACT
#ifdef OBSTACLES
/// What comes fast enough bounces: what it brought along the normal it gets back by the restitution. No more than the substep has
/// taken from it, as its inelastic end lost the square of all of it. @return  change of velocity [m/s]
vec3 bounceOf(Contact c, float restitution, vec3 v_before, vec3 v_next) {
  vec3 surface = c.way / dt_s;
  float approach = -dot(v_before - surface, c.normal);
  if (approach <= resting_speed) return vec3(0.0f);
  return max(0.0f, restitution * approach - dot(v_next - surface, c.normal)) * c.normal;
}
#endif

/// Tells probes and obstacles what they gave a node.
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
/// A probe that only feels counts the nodes whose tissue it meets.
void feel(uint slot, vec3 x) {
  for (uint s = 0u; s < kMaxStyluses; ++s) {
    ToolMotion motion = tool_motions[s];
    if ((motion.info.y & kToolPushes) == 0u || (motion.info.y & kToolFeels) == 0u) continue;
    if (isFelt(motion, slot, surfaceDepth(slot), x)) giveMomentum(s, slot, vec3(0.0f));
  }
}
#endif
