// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "solver/reference/derivatives.h"
#include "support/lattices.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kMomentsSpacing_m = 0.01;

Body askew() {
  return momentBody({3, 3, 3}, kMomentsSpacing_m, [](const Vector3d& p) { return p.dot(Vector3d(1, 0.7, 0.4)) < 3.1; });
}

Field randomField(const ReferenceLattice& lattice, double size_m) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-size_m, size_m);
  Field u(lattice.slots(), Vector3d::Zero());
  for (const uint32_t slot : lattice.active) u[slot] = Vector3d(any(random), any(random), any(random));
  return u;
}

}  // namespace

TEST(MomentCells, ForcesAndStiffnessAreDerivativesOfTheEnergy) {
  constexpr double kDifference = 1e-5;  // of central differences of the energy, of the largest force
  for (const double nu : {0.0, 0.25, 0.45}) {
    for (const double size : {0.02, 0.2, 0.5}) {
      Body body = askew();
      body.material.poisson_ratio = nu;
      const Model model = modelOf({body});
      const ReferenceLattice lattice(model);
      const Field u = randomField(lattice, size * kMomentsSpacing_m);
      EXPECT_LT(forceError(lattice, u, kMomentsSpacing_m), kDifference) << nu << ' ' << size;
      EXPECT_LT(stiffnessError(lattice, u, kMomentsSpacing_m), kDifference) << nu << ' ' << size;
    }
  }
}

TEST(MomentCells, RigidMotionHasNoEnergyAndTurningChangesNone) {
  constexpr double kRounding = 1e-12;  // of the energy of the same strain
  const Model model = modelOf({askew()});
  const ReferenceLattice lattice(model);
  const Field u = randomField(lattice, 0.1 * kMomentsSpacing_m);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  Field turned(lattice.slots(), Vector3d::Zero()), rigid = turned;
  for (const uint32_t slot : lattice.active) {
    const Vector3d x = lattice.restPosition(slot);
    turned[slot] = turn * (x + u[slot]) - x + Vector3d(0.1, 0, 0.3);
    rigid[slot] = turn * x - x;
  }
  const double energy_j = lattice.elasticEnergy(u), moments_j = lattice.momentEnergy(u);
  EXPECT_NEAR(lattice.elasticEnergy(turned), energy_j, kRounding * energy_j);
  EXPECT_NEAR(lattice.momentEnergy(turned), moments_j, kRounding * energy_j);
  EXPECT_NEAR(lattice.elasticEnergy(rigid), 0, kRounding * energy_j);
  EXPECT_GT(std::abs(moments_j), 0.01 * energy_j) << "moments have no say here";
}

/// A full cell bends as a plate and twists as a bar: E h / (6 (1 - nu^2)) [[1, nu], [nu, 1]] and mu h/3 with mu h/6
/// between (springs and moments together).
TEST(MomentCells, OneCellBendsAndTwistsAsTheSolidDoes) {
  constexpr double kSmall = 1e-5;  // of the spacing: strains above are of second order
  for (const double nu : {0.0, 0.25, 0.45}) {
    Body body = momentBody({1, 1, 1}, kMomentsSpacing_m, [](const Vector3d&) { return true; });
    body.material.poisson_ratio = nu;
    const Model model = modelOf({body});
    const ReferenceLattice lattice(model);
    const double young = body.material.young_modulus_pa, mu = young / (2 * (1 + nu)), h = kMomentsSpacing_m;
    const auto energy = [&](double bend_x, double bend_y, double twist) {
      Field u(lattice.slots(), Vector3d::Zero());
      for (const uint32_t slot : lattice.active) {
        const Vector3d p = lattice.restPosition(slot) / h - Vector3d::Constant(0.5);
        u[slot] =
            h * kSmall *
            Vector3d(bend_x * p.x() * p.z() - twist * p.y() * p.z(), bend_y * p.y() * p.z() + twist * p.x() * p.z(), 0);
      }
      return lattice.elasticEnergy(u) / (h * h * h * kSmall * kSmall);
    };
    const double plate = young / (24 * (1 - nu * nu));
    EXPECT_NEAR(energy(1, 0, 0) / plate, 1, 1e-3) << nu;
    EXPECT_NEAR(energy(1, 1, 0) / plate, 2 + 2 * nu, 2e-3) << nu;
    // Twist about z: gradients of the two shears at once, mu/2 (1/12 + 1/12) and nothing in the third plane.
    EXPECT_NEAR(energy(0, 0, 1) / (mu / 12), 1, 1e-3) << nu;
  }
}

/// A plate of cells of which the lower half is tissue: what bends is half a cell thick, and about its own middle.
TEST(MomentCells, TissueOnOneSideOfACellBendsAboutItsOwnMiddle) {
  constexpr double kBend = 1e-5;         // of the spacing: strains above are of second order
  constexpr double kSecondOrder = 1e-3;  // what is left of them
  Body body = momentBody({8, 1, 1}, kMomentsSpacing_m, [](const Vector3d& p) { return p.z() < 0.5; });
  const Model model = modelOf({body});
  const ReferenceLattice lattice(model);
  const double h = kMomentsSpacing_m, young = body.material.young_modulus_pa, nu = body.material.poisson_ratio;
  const auto energy = [&](double middle) {
    Field u(lattice.slots(), Vector3d::Zero());
    for (const uint32_t slot : lattice.active) {
      const Vector3d p = lattice.restPosition(slot) / h - Vector3d(4, 0.5, 0);
      const double thinned = nu / (1 - nu) * (0.5 - middle) * p.z();  // by the mean strain of the cell
      u[slot] = h * kBend * Vector3d(p.x() * (p.z() - middle), 0, -0.5 * p.x() * p.x() - thinned);
    }
    return lattice.elasticEnergy(u) / (8 * h * h * h * kBend * kBend);
  };
  const double plate = young / (1 - nu * nu) / 2, of_itself = 0.125 / 12;
  EXPECT_NEAR(energy(0.25) / (plate * of_itself), 1, kSecondOrder);
  EXPECT_NEAR(energy(0.5) / (plate * (of_itself + 0.5 * 0.25 * 0.25)), 1, kSecondOrder);
}

/// Springs alone resist being squeezed to a quarter hardly more than to a half, and to nothing less: a cell under a
/// tool would collapse, and its corners go through one another.
TEST(MomentCells, ACrushedCellResistsEverMore) {
  constexpr double kAtLeast = 1.5;  // of the force at a half: what springs lose (to 0.9 of it) and more is made good
  constexpr double kLetsGo = 0.75;  // of the largest force before: one corner alone is held by little
  for (const double nu : {0.0, 0.25, 0.45}) {
    Body body = momentBody({1, 1, 1}, kMomentsSpacing_m, [](const Vector3d&) { return true; });
    body.material.poisson_ratio = nu;
    const Model model = modelOf({body});
    const ReferenceLattice lattice(model);
    const double h = kMomentsSpacing_m;
    const auto squeezed = [&](double by) {  // sides held
      Field u(lattice.slots(), Vector3d::Zero());
      for (const uint32_t slot : lattice.active) u[slot].z() = -by * lattice.restPosition(slot).z();
      return lattice.elasticEnergy(u);
    };
    const auto pushed = [&](double by) {  // one corner along the diagonal, towards the other end
      Field u(lattice.slots(), Vector3d::Zero());
      for (const uint32_t slot : lattice.active) {
        if (lattice.restPosition(slot).minCoeff() > 0.5 * h) u[slot] = Vector3d::Constant(-by * h);
      }
      return lattice.elasticEnergy(u);
    };
    const auto force = [](const auto& energy, double by) {
      constexpr double kStep = 1e-4;
      return (energy(by + kStep) - energy(by - kStep)) / (2 * kStep);
    };
    double before = 0, largest = 0;
    for (int percent = 5; percent <= 95; percent += 5) {
      const double now = force(squeezed, 0.01 * percent), corner = force(pushed, 0.01 * percent);
      EXPECT_GT(now, before) << nu << ' ' << percent;
      EXPECT_GT(corner, kLetsGo * largest) << nu << ' ' << percent;
      before = now;
      largest = std::max(largest, corner);
    }
    EXPECT_GT(force(squeezed, 0.9), kAtLeast * force(squeezed, 0.5)) << nu;
  }
}
