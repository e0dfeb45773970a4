// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// implicit_fold.comp - sums the energies of implicit_guess.comp in a fixed tree and chooses the best share.
// Owner: solver/gpu/steps/gpu_device.h   physics.md 2
// in  energies of the nodes, then of runs     out  energies of runs; guard[0]: float bits of the share
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/shares.glsl"

#ifndef __cplusplus
const uint kRun = 64u;
layout(std430, binding = kBindPartials) buffer PartialsBuffer { vec4 energies[]; };
layout(std430, binding = kBindGuard) buffer GuardBuffer { uint guard[]; };
uniform uint count;
uniform uint input_first;
uniform uint output_first;
uniform uint last_level;
uniform uint bound_energy;  // 1: a share that ends with more energy than before is rejected
#endif

bool atMost(float a, float b) { return a <= b + kRounding * abs(b); }

/// Returns the largest share that no smaller one improves. A non-finite value is never at most another; 0 is always acceptable.
int bestShare(vec4 potential, vec4 energy) {
  int best = 3;
  for (int c = 2; c >= 0; --c) {
    bool gains = bound_energy != 0u && !atMost(energy[best], energy[0]);
    if (gains || !atMost(potential[best], potential[c])) best = c;
  }
  return best;
}

#ifndef __cplusplus  // in C++ the sums are in float64
void main() {
  uint run = globalIndex();
  if (run * kRun >= count) return;
  vec4 potential = vec4(0.0f), energy = vec4(0.0f);
  uint end = min((run + 1u) * kRun, count);
  for (uint i = run * kRun; i < end; ++i) {
    potential += energies[ENERGIES_PER_NODE * (input_first + i)];
    energy += energies[ENERGIES_PER_NODE * (input_first + i) + 1u];
  }
  energies[ENERGIES_PER_NODE * (output_first + run)] = potential;
  energies[ENERGIES_PER_NODE * (output_first + run) + 1u] = energy;
  if (last_level != 0u) guard[0] = floatBitsToUint(kShares[bestShare(potential, energy)]);
}
#endif
