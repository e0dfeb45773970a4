// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a cell in a thin wall adds to its energy by moments (physics.md 1, Thin walls): M s s / 2 + s N e over rigidity, s its hourglass
// motions along its edges, e its strains. Before moments.glsl.
// Features: THIN_WALLS (some cells lie in thin walls)
#if defined(THIN_WALLS) || defined(__cplusplus)
#define HAS_THIN_WALLS

#ifndef __cplusplus
/// One of a bend's numbers. @param bend  where they are, in kBendVectors
float bendNumber(uint bend, uint number);
#endif

/// Energy, and its derivatives by s of each edge, by strains along edges and by shears, all over rigidity.
struct CellBendPull {
  float energy;
  vec3 a, b, c, strains, shears;
};

/// @param bend  where its numbers are, in kBendVectors   @param sa, sb, sc  s of each edge
CellBendPull bendPull(uint bend, vec3 sa, vec3 sb, vec3 sc, vec3 strain, vec3 shear) {
  float s[9], r[9], e[6], p[6];
  s[0] = sa.x; s[1] = sa.y; s[2] = sa.z; s[3] = sb.x; s[4] = sb.y; s[5] = sb.z; s[6] = sc.x; s[7] = sc.y; s[8] = sc.z;
  e[0] = strain.x; e[1] = strain.y; e[2] = strain.z; e[3] = shear.x; e[4] = shear.y; e[5] = shear.z;
  for (uint i = 0u; i < 9u; ++i) r[i] = 0.0f;
  for (uint i = 0u; i < 6u; ++i) p[i] = 0.0f;
  uint number = 0u;
  for (uint i = 0u; i < 9u; ++i) {
    for (uint j = i; j < 9u; ++j) {
      float m = bendNumber(bend, number);
      r[i] += m * s[j];
      if (j != i) r[j] += m * s[i];
      ++number;
    }
  }
  float energy = 0.0f;
  for (uint i = 0u; i < 9u; ++i) energy += 0.5f * r[i] * s[i];
  for (uint i = 0u; i < 9u; ++i) {
    for (uint j = 0u; j < 6u; ++j) {
      float m = bendNumber(bend, number);
      r[i] += m * e[j];
      p[j] += m * s[i];
      ++number;
    }
  }
  for (uint j = 0u; j < 6u; ++j) energy += p[j] * e[j];
  CellBendPull pull;
  pull.energy = energy;
  pull.a = vec3(r[0], r[1], r[2]);
  pull.b = vec3(r[3], r[4], r[5]);
  pull.c = vec3(r[6], r[7], r[8]);
  pull.strains = vec3(p[0], p[1], p[2]);
  pull.shears = vec3(p[3], p[4], p[5]);
  return pull;
}
#endif
