// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// multigrid_vectors.comp - vectors of conjugate gradients.   Owner: solver/gpu/steps/multigrid_stages.h   physics.md 2
// Features: DOT (partial sums of x . y), DIRECTION (p = z + beta p), ADVANCE (s += alpha p, r -= alpha q; partial sums of r . r),
// BALANCE (residual of an increment, of nodes that can move), MASK (without those who are held; partial sums of energies)
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/multigrid/multigrid.glsl"
#if defined(DOT) || defined(ADVANCE) || defined(MASK)
#include "solver/multigrid/multigrid_sums.glsl"
#endif
#if defined(DIRECTION) || defined(ADVANCE)
layout(std430, binding = kBindSums) readonly buffer SumsBuffer { MultigridScalars scalars; };
#endif

uniform uint x_vector;
uniform uint y_vector;
uniform uint first;     // DIRECTION: of the first iteration
uniform float inertia;  // a0 [1/s2]

/// Products of components in float32, their sum in float64.
double dotOf(vec3 x, vec3 y) { return double(x.x * y.x) + double(x.y * y.y) + double(x.z * y.z); }

#ifdef DIRECTION
void each(uint slot) {
  vec3 z = ofSystem(kSystemCorrection, slot);
  setOfSystem(kSystemDirection, slot, scalars.beta == 0.0f ? z : z + scalars.beta * ofSystem(kSystemDirection, slot));
  if (first != 0u) setOfSystem(kSystemSolution, slot, vec3(0.0f));
}
#endif
#ifdef BALANCE
void each(uint slot) {
  NodeBits bits = nodes[slot];
  BodyParams body = bodies[bodyOf(bits)];
  vec3 pull = gravity + inertia * (ofStep(kStepWanted, slot) - ofStep(kStepIncrement, slot)) - body.drag_per_s * ofStep(kStepSpeed, slot);
  vec3 sum = ofStep(kStepForce, slot) + ofStep(kStepLoad, slot) + nodeMass(slot, bits, body) * pull;
  setOfSystem(kSystemResidual, slot, movable(slot) * sum);
}
#endif
#ifdef DOT
dvec4 each(uint slot) { return dvec4(dotOf(ofSystem(x_vector, slot), ofSystem(y_vector, slot)), 0.0LF, 0.0LF, 0.0LF); }
#endif
#ifdef ADVANCE
dvec4 each(uint slot) {
  vec3 r = ofSystem(kSystemResidual, slot);
  if (scalars.alpha != 0.0f) {  // else nothing is done, whatever the direction is
    r -= scalars.alpha * ofSystem(kSystemProduct, slot);
    setOfSystem(kSystemSolution, slot, ofSystem(kSystemSolution, slot) + scalars.alpha * ofSystem(kSystemDirection, slot));
    setOfSystem(kSystemResidual, slot, r);
  }
  return dvec4(dotOf(r, r), 0.0LF, 0.0LF, 0.0LF);
}
#endif

#ifdef MASK
/// @param more  the second row
dvec4 each(uint slot, out dvec4 more) {
  vec3 r = projected(slot, isFree(slot) * ofSystem(kSystemResidual, slot));
  setOfSystem(kSystemResidual, slot, r);
  NodeBits bits = nodes[slot];
  float mass = movable(slot) * nodeMass(slot, bits, bodies[bodyOf(bits)]);
  vec3 u = ofStep(kStepPlace, slot), v = ofStep(kStepSpeed, slot), du = ofStep(kStepIncrement, slot);
  vec3 load = mass * gravity + movable(slot) * ofStep(kStepLoad, slot);
  vec3 off = du - ofStep(kStepWanted, slot);
  more = dvec4(double(0.5f * mass * inertia) * dotOf(off, off), 0.0LF, 0.0LF, 0.0LF);
#ifdef HELD
  more.y = dotOf(touched[kTouchedLacks * slot_count + slot].xyz, du);
#endif
  return dvec4(dotOf(r, r), dotOf(u, u), double(0.5f * mass * dot(v, v)), double(dot(load, u)));
}

void main() {
  uint i = globalIndex();
  dvec4 row = dvec4(0.0LF), more = dvec4(0.0LF);
  if (i < active_count) row = each(active_nodes[i], more);
  sumUp(0u, row);
  sumUp(1u, more);
}
#elif defined(DOT) || defined(ADVANCE)
void main() {
  uint i = globalIndex();
  dvec4 row = dvec4(0.0LF);
  if (i < active_count) row = each(active_nodes[i]);
  sumUp(0u, row);
}
#else
void main() {
  uint i = globalIndex();
  if (i < active_count) each(active_nodes[i]);
}
#endif
