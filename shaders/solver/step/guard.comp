// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// guard.comp - restores the last saved state if the tick just measured was bad.
// Owner: solver/gpu/guard_pass.h   physics.md 3 (the rules of StabilityMonitor::inspect, in float32)
// in  stats, saved displacement and velocity [slots]     out  displacement, velocity [slots], in place
#include "layout.h"
#include "solver/tissue/lattice.glsl"

layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindStats) readonly buffer StatsBuffer { TickStats stats; };
layout(std430, binding = kBindSavedDisplacement) readonly buffer SavedDisplacement { vec4 saved_displacement[]; };
layout(std430, binding = kBindSavedVelocity) readonly buffer SavedVelocity { vec4 saved_velocity[]; };
layout(std430, binding = kBindDisplacementIn) writeonly buffer DisplacementBuffer { vec4 current_displacement[]; };
layout(std430, binding = kBindVelocityIn) writeonly buffer VelocityBuffer { vec4 current_velocity[]; };
#ifdef COMPENSATED
layout(std430, binding = kBindCompensation) writeonly buffer CompensationBuffer { vec4 compensation[]; };
#endif

uniform uint active_count;
uniform float most_speed;     // m/s; infinite if the integrator permits high speeds
uniform float most_energy_j;  // without the work of the tick's tools
uniform float energy_margin;  // factor on that work
uniform vec3 tip_speed[kMaxStyluses];  // of the tools, mean over the tick [m/s]
#ifdef SHAFTS
uniform vec3 spin[kMaxStyluses];  // of the same [rad/s]; 0 without a shaft that tissue meets
#endif

bool isBad() {
  float work = 0.0;
  for (uint s = 0u; s < kMaxStyluses; ++s) {
    float given = dot(stats.impulse[s].xyz, tip_speed[s]);
#ifdef SHAFTS
    given += dot(stats.angular[s].xyz, spin[s]);
#endif
    work += max(0.0, given);
  }
  float energy = stats.kinetic_j + stats.elastic_j;
  uint bits = floatBitsToUint(energy);  // comparisons with NaN depend on the compiler; its bits do not
  bool finite = (bits & 0x7f800000u) != 0x7f800000u;
  return stats.nonfinite > 0u || !finite || energy > most_energy_j + energy_margin * work ||
         uintBitsToFloat(stats.max_speed_bits) > most_speed;
}

void main() {
  uint i = globalIndex();
  if (i >= active_count || !isBad()) return;
  uint slot = active_nodes[i];
  current_displacement[slot] = saved_displacement[slot];
  current_velocity[slot] = saved_velocity[slot];
#ifdef COMPENSATED
  compensation[2u * slot] = vec4(0.0);
  compensation[2u * slot + 1u] = vec4(0.0);
#endif
}
