// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Force on a node in an iterate of implicit Euler, for a Jacobi sweep in majorise-minimise form. After implicit.glsl.
/// Returns the force on a node less its inertia [N]; w the majoriser [N/m].
vec4 pull(uint slot, NodeBits bits, BodyParams body, vec3 u, vec3 du) {
  float inertia_n_per_m = inertia(nodeMass(slot, bits, body), body);
  vec4 sum = vec4(inertia_n_per_m * (freeIncrement(slot, body) - du), inertia_n_per_m);
#define VISIT_LINK                                                            \
  ImplicitSpring s = implicitSpring(n, u, du, d, l0, prestrain, k, body);     \
  sum += vec4(s.force, k + s.damping);
  FOR_EACH_LINK
#undef VISIT_LINK
  return sum;
}
