// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// node_window.comp - transfers the state of a few nodes to the host, and changes to them back.
// Owner: solver/gpu/contact/node_window.h
// in  slots of the nodes     GATHER: out  window: displacements, then velocities     else: in  window: changes of velocity
// in/out  displacement, velocity, impulses. Feature ASLEEP: bricks may sleep; a change wakes them.
// One invocation per node; no node is listed twice.
#undef LOADS  // the buffer that it writes must not be read through another binding
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"

layout(std430, binding = kBindWindowSlots) readonly buffer WindowSlotsBuffer { uint window_slots[]; };
layout(std430, binding = kBindWindow) buffer WindowBuffer { vec4 window[]; };
#ifdef ASLEEP
layout(std430, binding = kBindSleepingBricks) buffer SleepingBuffer { SleepingBrick sleeping[]; };
#endif
uniform uint node_count;

#ifdef GATHER
/// Returns 1 if a change of the node must wake its brick first.
float asleep(uint slot) {
#ifdef ASLEEP
  SleepingBrick brick = sleeping[slot >> 6];
  return brick.kind == kMayMove && brick.awake == 0u ? 1.0f : 0.0f;
#else
  return 0.0f;
#endif
}

void inspect(uint i, uint slot) {
  window[i] = vec4(stateAt(displacement, int(slot)).xyz, asleep(slot));
  window[node_count + i] = stateAt(velocity, int(slot));
}
#else
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementIn) buffer DisplacementIn { vec4 own_displacement[]; };
layout(std430, binding = kBindVelocityIn) buffer VelocityIn { vec4 own_velocity[]; };
layout(std430, binding = kBindImpulses) buffer ImpulsesBuffer { vec4 impulses[]; };
uniform uint slot_count;
uniform uint giver;  // stylus that gives the momentum; kMaxStyluses: none

void wake(uint slot) {
#ifdef ASLEEP
  if (sleeping[slot >> 6].kind != kMayMove) return;
  sleeping[slot >> 6].quiet_s = 0.0f;
  sleeping[slot >> 6].awake = 1u;
#endif
}

void push(uint slot, vec3 change) {
  NodeBits bits = nodes[slot];
  if (isAtRest(bits) || change == vec3(0.0f)) return;
  precise vec3 move = dt_s * change;
  own_velocity[slot].xyz += change;
  own_displacement[slot].xyz += move;
  if (giver < kMaxStyluses)
    impulses[giver * slot_count + slot] += vec4(nodeMass(slot, bits, bodies[bodyOf(bits)]) * change, 1.0f);
  wake(slot);
}
#endif

void main() {
  uint i = globalIndex();
  if (i >= node_count) return;
#ifdef GATHER
  inspect(i, window_slots[i]);
#else
  push(window_slots[i], xyz(window[i]));
#endif
}
