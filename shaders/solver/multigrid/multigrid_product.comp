// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// multigrid_product.comp - y = A x, or y = base - A x, A the tangent as multigrid_linearise.comp left it; 0 where not free.
// Owner: solver/gpu/steps/multigrid_stages.h   physics.md 2
// in  vector x, tangents; what x makes cells do to their corners (multigrid_cells.comp)     out  vector y
#include "layout.h"
#include "solver/tissue/lattice.glsl"
#include "solver/tissue/elastic.glsl"
#include "solver/tissue/step.glsl"
#include "solver/multigrid/multigrid.glsl"
#include "solver/multigrid/multigrid_springs.glsl"

uniform uint x_vector;
uniform uint y_vector;
uniform uint base_vector;
uniform uint subtract;

void main() {
  uint i = globalIndex();
  if (i >= active_count) return;
  uint slot = active_nodes[i];
  NodeBits bits = nodes[slot];
  vec3 near = ofSystem(x_vector, slot);
  vec3 sum = diagonal(slot) * near;
#define TIMES(spring, offset)                                                                                   \
  if (springCount(bits, spring) != 0u) {                                                                        \
    uint n = neighborSlot(slot, offset);                                                                        \
    sum += springTimes((spring & 1u) == 0u ? slot : n, spring >> 1, near - ofSystem(x_vector, n));              \
  }
  FOR_EACH_SPRING(TIMES)
#ifdef VOLUME
  sum -= xyz(volumeForce(slot));
#endif
  sum *= isFree(slot);
  if (subtract != 0u) sum = ofSystem(base_vector, slot) - sum;
  setOfSystem(y_vector, slot, projected(slot, sum));
}
