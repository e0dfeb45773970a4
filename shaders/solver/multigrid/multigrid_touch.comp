// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// multigrid_touch.comp - what grips, probes and obstacles do to nodes in a step.   Owner: solver/gpu/steps/multigrid_touch_pass.h
// physics.md 2 (src/solver/multigrid/steps/touching.h is its twin, and says how)
// Features: CONTACT, TOOLS, OBSTACLES, and one of BEGIN (a step begins), PLACE (increments that may not be are moved, and what they
// meet is looked for), PRESS (who is held where an increment leads), GIVE (a step ends).
#undef LOADS  // increments are not there
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/implicit/implicit.glsl"
#include "solver/implicit/implicit_contact.glsl"
#include "solver/implicit/implicit_give.glsl"
#include "solver/multigrid/multigrid.glsl"

#if defined(PLACE) || defined(PRESS)
layout(std430, binding = kBindSums) buffer SumsBuffer { MultigridScalars scalars; };
#endif
uniform float touch_share;  // of the step that the stage ends at
const uint kRounds = 6u;    // over the contacts of a node, which share what it lacks

/// A contact of a node as it is at the end of the stage.
Contact contactThen(uint slot, uint row) {
  Contact c = contactOf(slot, row);
  if (touch_share == 1.0f) return c;
  float way = dot(c.way, c.normal), inside = c.least - way;  // at the start of the step
  c.least = touch_share * way + (inside > 0.0f ? touch_share : 1.0f) * inside;
  c.way *= touch_share;
  return c;
}

#ifdef BEGIN
void each(uint slot) {
  clearContacts(slot);
  uint what = touchesOf(slot) & kTouchesBefore;
  vec3 way = vec3(0.0f);
#ifdef TOOLS
  NodeBits bits = nodes[slot];
  uint held_by = (bits.lo & kGrabMask) >> kGrabShift;
  if (held_by != 0u && !isAtRest(bits)) {
    what |= kTouchesHeld | kTouchesPresses;
    way = heldDisplacement(held_by - 1u, slot) - stateAt(displacement, int(slot)).xyz;
  }
#endif
  touched[kTouchedNormal * slot_count + slot] = vec4(0.0f);
  touched[kTouchedNormal2 * slot_count + slot] = vec4(0.0f);
  touched[kTouchedWay * slot_count + slot] = vec4(way, 0.0f);
  touched[kTouchedLacks * slot_count + slot] = vec4(0.0f);
  setTouches(slot, what);
}
#endif

#ifdef PLACE
/// The nearest increment that a node's contacts let be.
vec3 outsideThen(uint slot, vec3 du) {
  uint count = contactCount(slot);
  if (count > 0u && (touchesOf(slot) & kTouchesSticks) != 0u) {
    Contact c = contactThen(slot, 0u);
    vec3 slip = du - c.way;
    du -= slip - dot(slip, c.normal) * c.normal;
  }
  for (uint i = 0u; i < kRounds * count; ++i) {
    Contact c = contactThen(slot, i % count);
    du += max(0.0f, c.least - dot(c.normal, du)) * c.normal;
  }
  return du;
}

void each(uint slot) {
  if (movable(slot) == 0.0f) return;
  vec3 du = ofStep(kStepIncrement, slot);
  if ((touchesOf(slot) & kTouchesHeld) != 0u) {
    du = touch_share * touched[kTouchedWay * slot_count + slot].xyz;
  } else {
    findContacts(slot, stateAt(displacement, int(slot)).xyz, du / touch_share);
    du = outsideThen(slot, du);
  }
  setOfStep(kStepIncrement, slot, du);
}
#endif

#ifdef PRESS
/// Of the planes that press: normals at right angles.
struct Planes {
  uint count;
  vec3 axes[3];
};

void addAxis(vec3 axis, inout Planes planes) {
  for (uint other = 0u; other < planes.count; ++other) axis -= dot(axis, planes.axes[other]) * planes.axes[other];
  if (dot(axis, axis) > 1e-4f) planes.axes[planes.count++] = normalize(axis);
}

void press(uint slot, uint count, uint what) {
  float at_plane = 1e-4f * bodies[bodyOf(nodes[slot])].origin_spacing.w;  // nearer than that a node touches
  vec3 du = ofStep(kStepIncrement, slot), lacks = -ofSystem(kSystemResidual, slot), left = lacks;
  float pressures[kMostContacts];
  for (uint row = 0u; row < kMostContacts; ++row) pressures[row] = 0.0f;
  for (uint i = 0u; i < (count > 1u ? kRounds : 1u) * count; ++i) {
    Contact c = contactThen(slot, i % count);
    if (dot(c.normal, du) > c.least + at_plane) continue;
    float before = pressures[i % count];
    pressures[i % count] = max(0.0f, before + dot(c.normal, left));
    left -= (pressures[i % count] - before) * c.normal;
  }
  uint mask = 0u;
  Planes planes;
  planes.count = 0u;
  for (uint row = 0u; row < 3u; ++row) planes.axes[row] = vec3(0.0f);
  for (uint row = 0u; row < count; ++row) {
    if (pressures[row] <= 0.0f) continue;
    mask |= 1u << row;
    addAxis(contactOf(slot, row).normal, planes);
  }
  bool presses = planes.count > 0u, sticks = false;
  vec3 drag = vec3(0.0f);
  Contact only = contactThen(slot, 0u);
  if (planes.count == 1u && count == 1u && only.friction > 0.0f) {
    vec3 slip = du - only.way, along = slip - dot(slip, only.normal) * only.normal;
    vec4 m = system_vectors[kSystemInverse * slot_count + slot];
    float gives = min(min(m.x, m.w), system_vectors[kSystemInverse2 * slot_count + slot].y);
    vec3 wanted = left - dot(left, only.normal) * only.normal - along / max(gives, 1e-30f);
    float limit = only.friction * pressures[0], size = length(wanted);
    sticks = size <= limit;
    if (!sticks) drag = limit / size * wanted;
  }
  bool held = sticks || planes.count == 3u;
  touched[kTouchedNormal * slot_count + slot] = held ? vec4(0.0f, 0.0f, 0.0f, 1.0f) : vec4(planes.axes[0], 0.0f);
  touched[kTouchedNormal2 * slot_count + slot] = held ? vec4(0.0f) : vec4(planes.axes[1], 0.0f);
  if (!held) setOfSystem(kSystemResidual, slot, -lacks + drag);
  touched[kTouchedLacks * slot_count + slot] = vec4(presses ? lacks - left + (sticks ? left : drag) : vec3(0.0f), 0.0f);
  uint now = (what & (kTouchesBefore | kTouchesEvenly)) | (presses ? kTouchesPresses : 0u) | (sticks ? kTouchesSticks : 0u) | mask << kTouchesMaskShift;
  setTouches(slot, now);
  if ((now | kTouchesPresses) != (what | kTouchesPresses)) scalars.changed = 1u;
}

void each(uint slot) {
  uint what = touchesOf(slot);
  if ((what & kTouchesHeld) != 0u) {
    touched[kTouchedNormal * slot_count + slot] = vec4(0.0f, 0.0f, 0.0f, 1.0f);
    touched[kTouchedLacks * slot_count + slot] = vec4(-ofSystem(kSystemResidual, slot), 0.0f);
    return;
  }
  uint count = contactCount(slot);
  if (count > 0u) press(slot, count, what);
}
#endif

#ifdef GIVE
/// What the balance lacks goes to the contacts that press, and friction. @param inertia_n  of a node that went on evenly [N]
void share(uint slot, uint mask, vec3 inertia_n) {
  uint count = contactCount(slot);
  vec3 left = touched[kTouchedLacks * slot_count + slot].xyz;
  for (uint i = 0u; i < kRounds * count; ++i) {
    if ((mask >> (i % count) & 1u) == 0u) continue;
    Contact c = contactOf(slot, i % count);
    float more = max(dot(left, c.normal), -dot(c.normal, c.force));
    node_contacts[contactAt(slot, i % count) + 2u] = vec4(c.force + more * c.normal, c.owner);
    left -= more * c.normal;
  }
  if (count != 1u || mask == 0u) return;
  Contact c = contactOf(slot, 0u);
  float stop = max(0.0f, dot(inertia_n, c.normal));
  node_contacts[contactAt(slot, 0u) + 2u] = vec4(c.force + left + stop * c.normal, c.owner);
}

void each(uint slot) {
  uint what = touchesOf(slot);
  NodeBits bits = nodes[slot];
  vec3 du = ofStep(kStepIncrement, slot);
  if ((what & kTouchesPresses) != 0u) {
    float mass = nodeMass(slot, bits, bodies[bodyOf(bits)]);
    vec3 v_next = du / dt_s;
    vec3 inertia_n = ((what & kTouchesEvenly) != 0u ? mass / dt_s : 0.0f) * (v_next - ofStep(kStepVelocity, slot));
#ifdef TOOLS
    if ((what & kTouchesHeld) != 0u)
      giveMomentum(((bits.lo & kGrabMask) >> kGrabShift) - 1u, slot, dt_s * (touched[kTouchedLacks * slot_count + slot].xyz + inertia_n));
#endif
    if ((what & kTouchesHeld) == 0u) {
      share(slot, what >> kTouchesMaskShift, inertia_n);
      giveContacts(slot, mass, v_next);
    }
    setOfStep(kStepSpeed, slot, v_next);
  }
  setTouches(slot, (what & kTouchesPresses) != 0u ? kTouchesBefore : 0u);
#ifdef TOOLS
  feel(slot, restPosition(slot) + stateAt(displacement, int(slot)).xyz + du);
#endif
}
#endif

void main() {
  uint i = globalIndex();
#ifdef PLACE
  if (i == 0u) scalars.changed = 0u;
#endif
  if (i < active_count) each(active_nodes[i]);
}
