// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A cell of a hyperelastic law that has lost a spring to a blade: from then on it consists of its remaining springs (physics.md
// 1, Law).
// After elastic.glsl and `nodes`. Feature: LAW

struct BrokenCell {
  vec3 force[8];  // on its corners [N]
  float energy;   // [J]
};

#ifdef PRESTRESS
/// Returns the strain n.E.n of springs that carry a cell's stress at rest, along a direction (model/fracture/cell_prestress.cpp),
/// with E = (S - tr S / 5) / 2.
float brokenStrain(CellMoments t, vec3 n) {
  vec3 s = vec3(t.pulled.x * n.x + t.sheared.z * n.y + t.sheared.y * n.z, t.sheared.z * n.x + t.pulled.y * n.y + t.sheared.x * n.z,
                t.sheared.y * n.x + t.sheared.x * n.y + t.pulled.z * n.z);
  return 0.5f * (dot(n, s) / dot(n, n) - (t.pulled.x + t.pulled.y + t.pulled.z) / 5.0f);
}
#endif

/// @param at  displacements of the corners, bit per axis, x lowest [m]   @param rigidity  mu h^3 times the cell's share [J]
BrokenCell brokenCell(uint slot, vec3 at[8], float h, float rigidity, CellMoments moments) {
  BrokenCell cell;
  cell.energy = 0.0f;
  for (uint c = 0u; c < 8u; ++c) cell.force[c] = vec3(0.0f);
  float quarter = rigidity / (4.0f * h * h);  // a cell's share of the stiffness of an edge; of a diagonal twice as much [N/m]
  for (uint c = 0u; c < 8u; ++c) {
    NodeBits bits = nodes[cornerSlot(slot, c)];
    ivec3 from = ivec3(c & 1u, (c >> 1) & 1u, (c >> 2) & 1u);
#ifdef PRESTRESS
#define BROKEN_STRAIN(offset) brokenStrain(moments, vec3(offset))
#else
#define BROKEN_STRAIN(offset) 0.0f
#endif
#define BROKEN_SPRING(spring, offset)                                                                                   \
  {                                                                                                                     \
    ivec3 to = from + offset;                                                                                           \
    if ((spring & 1u) == 0u && all(greaterThanEqual(to, ivec3(0))) && all(lessThanEqual(to, ivec3(1))) && springCount(bits, spring) != 0u) { \
      uint far = uint(to.x + 2 * to.y + 4 * to.z);                                                                      \
      float k = spring < kAxialSprings ? quarter : 2.0f * quarter;                                                      \
      float l0 = spring < kAxialSprings ? h : kSqrt2 * h;                                                               \
      float shorter = BROKEN_STRAIN(offset), prestrain = l0 * l0 * shorter * (2.0f - shorter);                          \
      Spring s = springBetween(h * vec3(offset), l0 * (1.0f - shorter), prestrain, at[far] - at[c]);                    \
      vec3 pull = (k * s.extension) * s.direction;                                                                      \
      cell.force[c] += pull;                                                                                            \
      cell.force[far] -= pull;                                                                                          \
      float at_rest = l0 * shorter; /* energy relative to the given shape, as of a whole cell */                        \
      cell.energy += 0.5f * k * (s.extension - at_rest) * (s.extension + at_rest);                                      \
    }                                                                                                                   \
  }
    FOR_EACH_SPRING(BROKEN_SPRING)
#undef BROKEN_SPRING
#undef BROKEN_STRAIN
  }
  return cell;
}
