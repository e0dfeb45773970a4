// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/specimens/scalar_lattice.h"

#include <gtest/gtest.h>

#include "bench/harness/specimens/specimen.h"

namespace viscera::bench {
namespace {

constexpr int kScalarLatticeSubsteps = 40;
// Rounding error of displacements of about 1e-3 m after as many additions in float32 [m].
constexpr double kRounding_m = 1e-3 * kScalarLatticeSubsteps / (1 << 24);

/// Returns the largest difference of a displacement from the float64 reference [m].
double errorOf(const Specimen& specimen) {
  const double dt_s = 0.5 * safeTimeStep(specimen.model);
  ScalarLattice scalar(specimen.model, specimen.start, dt_s);
  ReferenceSolver reference(specimen.model, Vector3d::Zero(), dt_s, {});
  const Lattice& lattice = specimen.model.bodies[0].lattice;
  for (uint32_t slot : lattice.active_slots) {
    reference.u_m[slot] = xyz(specimen.start.displacement_m[slot]);
    reference.v_m_per_s[slot] = xyz(specimen.start.velocity_m_per_s[slot]);
  }
  for (int s = 0; s < kScalarLatticeSubsteps; ++s) {
    scalar.substep();
    reference.substep({});
  }
  const std::vector<Vector3f> u = scalar.displacements();
  double worst = 0;
  for (size_t i = 0; i < u.size(); ++i)
    worst = std::max(worst, (u[i].cast<double>() - reference.u_m[lattice.active_slots[i]]).norm());
  return worst;
}

TEST(ScalarLattice, IsTheReferenceInFloat32) {
  EXPECT_LT(errorOf(cubeOf(6)), kRounding_m);
}

TEST(ScalarLattice, KnowsDashpotAndDrag) {
  MaterialConfig material = specimenMaterial(0.3);
  material.mass_damping_per_s = 50;
  EXPECT_LT(errorOf(cubeOf(6, material)), kRounding_m);
}

TEST(ScalarLattice, LeavesFixedNodesAndCutSpringsAlone) {
  Specimen specimen = cubeOf(5);
  Lattice& lattice = specimen.model.bodies[0].lattice;
  for (uint32_t slot : lattice.active_slots) {
    if (lattice.nodeAt(slot).z() == 0) lattice.nodes[slot].lo |= layout::kFixedBit;
    if (lattice.nodeAt(slot).x() == 2) lattice.nodes[slot].lo &= ~(7u << 3);  // to the left, from both ends
    if (lattice.nodeAt(slot).x() == 1) lattice.nodes[slot].lo &= ~7u;
  }
  specimen.start = wobbling(specimen.model, 1e-4, 1);
  EXPECT_LT(errorOf(specimen), kRounding_m);
}

}  // namespace
}  // namespace viscera::bench
