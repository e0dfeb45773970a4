// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// multigrid_tame.comp - a step that carries a node away from those around it is none: it hangs on few springs, which a step so long
// turns to where tangents knew nothing of. It goes on with the others.
// Owner: solver/gpu/steps/multigrid_stages.h   physics.md 2
// in  solution     out  the same in the correction
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/multigrid/multigrid.glsl"

vec3 tamedStep(uint slot) {
  const float apart_most = 0.3f;  // spacings: how far a step may carry a node from those around it
  NodeBits bits = nodes[slot];
  BodyParams body = bodies[bodyOf(bits)];
  vec3 own = ofSystem(kSystemSolution, slot), around = vec3(0.0f);
  float stiffness = 0.0f, apart = 0.0f;
#define VISIT_LINK                                       \
  vec3 other = ofSystem(kSystemSolution, n);             \
  stiffness += k;                                        \
  around += k * other;                                   \
  apart += k * distance(other, own);
  FOR_EACH_SPRING(LATTICE_LINK)
#undef VISIT_LINK
  float far_m = apart_most * body.origin_spacing.w;
  if (apart <= far_m * stiffness || isFree(slot) == 0.0f) return own;
  vec3 middle = around / stiffness;
  return middle + far_m * stiffness / apart * (own - middle);
}

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  setOfSystem(kSystemCorrection, slot, projected(slot, tamedStep(slot)));
}
