// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// multigrid_increment.comp - what becomes of increments, and where they lead.
// Owner: solver/gpu/steps/multigrid_stages.h   physics.md 2
// in, out  vectors of the step; solution of the system     Feature PLACE: places and velocities that increments lead to
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/multigrid/multigrid.glsl"

#ifdef PLACE
uniform float rate;  // 1/s

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  vec3 du = ofStep(kStepIncrement, slot);
  setOfStep(kStepPlace, slot, stateAt(displacement, int(slot)).xyz + du);
  setOfStep(kStepSpeed, slot, rate * (du - ofStep(kStepOffset, slot)));
}
#else
uniform uint becomes;  // kIncrement...
uniform float share;

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  vec3 du = ofStep(kStepIncrement, slot), trial = ofStep(kStepTrial, slot);
  if (becomes == kIncrementKeep) {
    setOfStep(kStepTrial, slot, du);
    return;
  }
  if (becomes == kIncrementSlow) {
    setOfStep(kStepSpeed, slot, share * ofStep(kStepSpeed, slot));
    return;
  }
  if (becomes == kIncrementTamed) du += ofSystem(kSystemCorrection, slot);
  else if (becomes == kIncrementSolve) du += ofSystem(kSystemSolution, slot);
  else if (becomes == kIncrementBack) du = trial + share * (du - trial);
  else if (becomes == kIncrementGuess) du = share * ofStep(kStepWanted, slot);
  else du = share * trial;
  setOfStep(kStepIncrement, slot, du);
}
#endif
