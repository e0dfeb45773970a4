// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/cell_stress.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/lattices.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kEdge_m = 0.01, kStretch = 1.2;

/// Returns the corners of a cell that is stretched along x, then turned by 90 degrees about z.
std::array<Vector3d, 8> stretchedAndTurned() {
  std::array<Vector3d, 8> out;
  for (size_t c = 0; c < 8; ++c) {
    const Vector3d rest = kEdge_m * Vector3d(c & 1, c >> 1 & 1, c >> 2 & 1);
    out[c] = Vector3d(-rest.y(), kStretch * rest.x(), rest.z()) - rest;
  }
  return out;
}

}  // namespace

/// Computed by hand: mu = 20e3 / 2.6, K = 20e3 / 1.2 at nu 0.3; J = l, B = (l^2, 1, 1).
TEST(CellStress, OfTheNeoHookeanLawIsCauchysForAnyOrientation) {
  Body body = boxBody({2, 2, 2}, kEdge_m);
  body.material.young_modulus_pa = 20e3;
  body.material.poisson_ratio = 0.3;
  body.material.law = Law::kNeoHookean;
  const double mu = 20e3 / 2.6, bulk = 20e3 / 1.2, l = kStretch;
  for (const double b : {0.0, 4.0}) {
    body.material.stiffening = b;
    const double x = std::pow(l, -2.0 / 3) * (l * l + 2) - 3, shear = mu * std::exp(b * x) * std::pow(l, -5.0 / 3);
    const double pressure = bulk / 2 * (l - 1 / l), mean = (l * l + 2) / 3;
    const CellStress stress = CellStresses(body).at(body.lattice.active_slots[0], stretchedAndTurned());
    constexpr double kRounding = 1e-9;
    EXPECT_NEAR(stress.principal_pa[0], shear * (l * l - mean) + pressure, kRounding * mu);
    EXPECT_NEAR(stress.principal_pa[1], shear * (1 - mean) + pressure, kRounding * mu);
    EXPECT_NEAR(stress.principal_pa[2], shear * (1 - mean) + pressure, kRounding * mu);
    EXPECT_NEAR(stress.von_mises_pa, shear * (l * l - 1), kRounding * mu);
    const double energy = mu / 2 * (b == 0 ? x : std::expm1(b * x) / b) + bulk / 4 * (l * l - 1 - 2 * std::log(l));
    EXPECT_NEAR(stress.energy_j_per_m3, energy, kRounding * mu);
  }
}

/// Two layers under tension across their interface carry the same stress, whichever of them is the cell's label.
TEST(CellStress, OfACellOfTwoMaterialsIsThatOfItsLabelsLayer) {
  constexpr double kNewton = 1e-6;  // share of the stress: the jump is exact to rounding, stress is its derivative
  Body body = ofLaw(boxBody({1, 1, 1}, kEdge_m), 0.3);
  body.material.young_modulus_pa = 20e3;
  body = twoMaterials(body, {1, 0, 0}, 0.4, {"stiff", 200e3, 0.3, 1e3});
  const uint32_t cell = body.lattice.active_slots[0];
  std::array<Vector3d, 8> u_m;
  for (size_t c = 0; c < 8; ++c) u_m[c] = Vector3d(c & 1 ? 0.2 * kEdge_m : 0, 0, 0);
  ASSERT_EQ(body.lattice.cell_labels[cell], 2);
  const CellStress stiff = CellStresses(body).at(cell, u_m);
  body.lattice.cell_labels[cell] = 1;
  const CellStress soft = CellStresses(body).at(cell, u_m);
  EXPECT_NEAR(stiff.principal_pa[0], soft.principal_pa[0], kNewton * soft.principal_pa[0]);
  EXPECT_GT(std::abs(stiff.principal_pa[1] - soft.principal_pa[1]), 0.01 * soft.principal_pa[0]);
  EXPECT_GT(soft.energy_j_per_m3, 3 * stiff.energy_j_per_m3);
}

TEST(CellStress, OfRestIsNothing) {
  for (const Law law : {Law::kSprings, Law::kNeoHookean}) {
    Body body = boxBody({2, 2, 2}, kEdge_m);
    body.material.law = law;
    std::array<Vector3d, 8> still;
    still.fill(Vector3d::Zero());
    const CellStress stress = CellStresses(body).at(body.lattice.active_slots[0], still);
    EXPECT_NEAR(stress.von_mises_pa, 0, 1e-9);
    EXPECT_NEAR(stress.principal_pa.norm(), 0, 1e-9);
  }
}
