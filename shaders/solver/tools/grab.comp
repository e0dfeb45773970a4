// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// grab.comp - grips the nodes around a stylus tip, or releases them.   Owner: solver/gpu/contact/grab_pass.h   VR05 2.7.2
// in  displacement, stats     in/out  nodes (grab bits), velocity     out  grab offsets
// Feature: RELEASE releases; without it the pass grips.
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/quaternion.glsl"

#ifndef __cplusplus
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementIn { vec4 displacement[]; };
layout(std430, binding = kBindVelocityIn) buffer VelocityIn { vec4 velocity[]; };
layout(std430, binding = kBindGrabOffsets) writeonly buffer GrabOffsetsBuffer { vec4 grab_offsets[]; };

uniform uint active_count;
uniform uint stylus;
uniform vec4 tip;          // xyz tip [m], w grab radius [m]
uniform vec4 orientation;  // of the stylus, quaternion xyzw
uniform float release_speed;  // largest |v| after release [m/s]
#ifdef RELEASE
uniform float above;  // release only if the stylus gave more than this in the tick [N s]; below 0: in any case
layout(std430, binding = kBindStats) readonly buffer StatsBuffer { TickStats stats; };
#endif
#endif

#ifndef RELEASE
#include "solver/tissue/surface_point.glsl"

/// Grips a node if its tissue is within reach.
void takeHold(uint slot, NodeBits bits) {
  if ((bits.lo & (kFixedBit | kGrabMask)) != 0u || isIsolated(bits)) return;
  vec3 offset = restPosition(slot) + xyz(displacement[slot]) - xyz(tip);
  vec3 reach = offset + toTissue(slot, bodies[bodyOf(bits)].origin_spacing.w);
  if (dot(reach, reach) > tip.w * tip.w) return;
  grab_offsets[slot] = vec4(rotated(conjugate(orientation), offset), 0.0f);
  nodes[slot].lo = bits.lo | ((stylus + 1u) << kGrabShift);
}
#endif

void letGo(uint slot, NodeBits bits) {
  if ((bits.lo & kGrabMask) >> kGrabShift != stylus + 1u) return;
  vec3 v = xyz(velocity[slot]);
  float speed = length(v);
  if (speed > release_speed) velocity[slot] = vec4(v * (release_speed / speed), 0.0f);
  nodes[slot].lo = bits.lo & ~kGrabMask;
}

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
#ifdef RELEASE
  if (length(xyz(stats.impulse[stylus])) <= above) return;
  letGo(slot, nodes[slot]);
#else
  takeHold(slot, nodes[slot]);
#endif
}
