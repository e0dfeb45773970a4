// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// measure.comp - what a tick left behind: non-finite nodes, largest stretch and speed, held nodes.
// Owner: solver/gpu/measure_pass.h.   Integer atomics only: sums and maxima do not depend on the order.
#include "layout.h"
#include "lattice.glsl"
#include "spring.glsl"

layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindNodes) readonly buffer NodesBuffer { NodeBits nodes[]; };
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementIn { vec4 displacement[]; };
layout(std430, binding = kBindVelocityIn) readonly buffer VelocityIn { vec4 velocity[]; };
layout(std430, binding = kBindStats) buffer StatsBuffer { TickStats stats; };
layout(location = 0) uniform uint active_count;

/// Compilers drop isnan(); the bits do not lie (physics.md 2).
bool finite(vec3 v) {
  uvec3 bits = floatBitsToUint(v) & 0x7f800000u;
  return all(notEqual(bits, uvec3(0x7f800000u)));
}

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  vec3 u = displacement[slot].xyz, v = velocity[slot].xyz;
  if (!finite(u) || !finite(v)) {
    atomicAdd(stats.nonfinite, 1u);
    return;
  }
  float h = bodies[bodyOf(bits)].origin_spacing.w;
  float stretch = 0.0;
#define STRETCH(spring, offset)                                                                            \
  if ((spring & 1u) == 0u && springCount(bits, spring) != 0u) {                                            \
    vec3 far = displacement[neighborSlot(slot, offset)].xyz;                                               \
    float l0 = spring < kAxialSprings ? h : kSqrt2 * h;                                                    \
    if (finite(far)) stretch = max(stretch, abs(springBetween(h * vec3(offset), l0, far - u).extension) / l0); \
  }
  FOR_EACH_SPRING(STRETCH)
  // Positive floats order like their bits. The look before the atomic only saves work: the maximum is the same.
  uint stretch_bits = floatBitsToUint(stretch), speed_bits = floatBitsToUint(length(v));
  if (stretch_bits > stats.max_stretch_bits) atomicMax(stats.max_stretch_bits, stretch_bits);
  if (speed_bits > stats.max_speed_bits) atomicMax(stats.max_speed_bits, speed_bits);
  uint held_by = (bits.lo & kGrabMask) >> kGrabShift;
  if (held_by != 0u) atomicAdd(stats.grabbed[held_by - 1u], 1u);
}
