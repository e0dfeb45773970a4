// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// sum_impulses.comp - momentum given by each stylus over the tick, and its moment about the tip; or, feature OBSTACLES, by two
// obstacles, about their positions.
// Owner: solver/gpu/forces/reaction_pass.h   physics.md 5
// A fixed tree of additions: level 0 (feature LEAVES) reduces runs of nodes to partial sums and clears the impulses. Later levels
// reduce runs of partial sums until one is left, which goes into the stats. The order never changes, so neither does the sum.
#include "layout.h"
#include "solver/tissue/lattice.glsl"


struct Partial {
  vec4 impulse[2];  // xyz N s; w nodes touched
  vec4 angular[2];  // xyz N m s
};
layout(std430, binding = kBindPartials) buffer PartialsBuffer { Partial partials[]; };
layout(std430, binding = kBindStats) buffer StatsBuffer { TickStats stats; };

const uint kRun = 64u;
uniform uint input_count;
uniform uint input_first;   // of the partial sums
uniform uint output_first;
uniform uint last_level;
uniform uint first_giver;  // of the two

#ifdef LEAVES
uniform uint slot_count;
uniform vec3 tips[2];  // stylus tips at the end of the tick [m]
layout(std430, binding = kBindActive) readonly buffer ActiveBuffer { uint active_nodes[]; };
layout(std430, binding = kBindDisplacementIn) readonly buffer DisplacementIn { vec4 displacement[]; };
#ifdef OBSTACLES
layout(std430, binding = kBindObstacleImpulses) buffer ImpulsesBuffer { vec4 impulses[]; };
#else
layout(std430, binding = kBindImpulses) buffer ImpulsesBuffer { vec4 impulses[]; };
#endif

void add(inout Partial sum, uint i) {
  uint slot = active_nodes[i];
  for (uint s = 0u; s < kMaxStyluses; ++s) {
    uint position = (first_giver + s) * slot_count + slot;
    if (position >= uint(impulses.length())) continue;  // with an odd number of obstacles
    vec4 impulse = impulses[position];
    if (impulse.w == 0.0) continue;
    vec3 arm = restPosition(slot) + displacement[slot].xyz - tips[s];
    sum.impulse[s] += vec4(impulse.xyz, 1.0);
    sum.angular[s].xyz += cross(arm, impulse.xyz);
    impulses[position] = vec4(0.0);
  }
}
#else
void add(inout Partial sum, uint i) {
  Partial p = partials[input_first + i];
  for (uint s = 0u; s < kMaxStyluses; ++s) {
    sum.impulse[s] += p.impulse[s];
    sum.angular[s] += p.angular[s];
  }
}
#endif

void main() {
  uint run = globalIndex();
  if (run * kRun >= input_count) return;
  Partial sum;
  for (uint s = 0u; s < kMaxStyluses; ++s) sum.impulse[s] = sum.angular[s] = vec4(0.0);
  uint end = min((run + 1u) * kRun, input_count);
  for (uint i = run * kRun; i < end; ++i) add(sum, i);
  partials[output_first + run] = sum;
  if (last_level == 0u) return;
  for (uint s = 0u; s < kMaxStyluses; ++s) {
#ifdef OBSTACLES
    if (first_giver + s >= kMaxObstacles) continue;
    stats.obstacle_impulse[first_giver + s] = sum.impulse[s];
    stats.obstacle_angular[first_giver + s] = sum.angular[s];
#else
    stats.impulse[s] = sum.impulse[s];
    stats.angular[s] = sum.angular[s];
    stats.touched[s] = uint(sum.impulse[s].w);
#endif
  }
}
