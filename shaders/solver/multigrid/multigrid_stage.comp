// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// multigrid_stage.comp - what a stage of TR-BDF2 or implicit Euler solves for: dy, dw, and the first guess.
// Owner: solver/gpu/steps/multigrid_stages.h   physics.md 2 (src/solver/multigrid/steps/step_rules.h has the numbers)
// in, out  vectors of the step
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/multigrid/multigrid.glsl"

uniform uint stage;
uniform float inertia;   // a0 [1/s2]
uniform float rate;      // 1/s
uniform float gamma_of;  // share of the step that the trapezoidal stage takes
uniform float of_middle;
uniform float of_start;
uniform float second_s;  // c of the BDF2 stage

bool touches(uint slot, uint what) {
#ifdef HELD
  return (touchesOf(slot) & what) != 0u;
#else
  return false;
#endif
}

/// From forces at the start.
void trapezoidal(uint slot) {
  NodeBits bits = nodes[slot];
  BodyParams body = bodies[bodyOf(bits)];
  vec3 v = ofStep(kStepVelocity, slot);
  float first = gamma_of * dt_s;
  vec3 a = movable(slot) * ((ofStep(kStepForce, slot) + ofStep(kStepLoad, slot)) / nodeMass(slot, bits, body) + gravity - body.drag_per_s * v);
  // What pressed a node balanced these forces.
  setOfStep(kStepWanted, slot, first * v + (touches(slot, kTouchesBefore | kTouchesHeld) ? vec3(0.0f) : a / inertia));
  setOfStep(kStepOffset, slot, v / rate);
  setOfStep(kStepIncrement, slot, first * v);
}

/// From the solution of the trapezoidal stage. A surface has stopped those that press: they go on evenly.
void bdf2(uint slot) {
  vec3 v = ofStep(kStepVelocity, slot), increment = ofStep(kStepIncrement, slot);
  vec3 speed = rate * (increment - ofStep(kStepOffset, slot));
  vec3 wanted = of_middle * increment + second_s * (of_middle * speed - of_start * v);
  vec3 guess = increment + ((1.0f - gamma_of) * dt_s) * speed;
  setOfStep(kStepOffset, slot, of_middle * increment);
#ifdef HELD
  uint what = touchesOf(slot) & ~kTouchesEvenly;
  if ((what & kTouchesPresses) != 0u) {
    what |= kTouchesEvenly;
    wanted = guess = increment / gamma_of;
  }
  setTouches(slot, what);
#endif
  setOfStep(kStepWanted, slot, wanted);
  setOfStep(kStepIncrement, slot, guess);
}

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  if (stage == kStageTrapezoidal) {
    trapezoidal(slot);
  } else if (stage == kStageBdf2) {
    bdf2(slot);
  } else {
    setOfStep(kStepWanted, slot, dt_s * ofStep(kStepVelocity, slot));
    setOfStep(kStepOffset, slot, vec3(0.0f));
    setOfStep(kStepIncrement, slot, vec3(0.0f));
  }
}
