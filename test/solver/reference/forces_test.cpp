// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "solver/reference/derivatives.h"
#include "solver/reference/reference_bodies.h"

namespace viscera {
namespace {

using namespace test;

/// Returns displacements that scale the body, or invert it.
Field blownUp(const ReferenceLattice& lattice, double factor, double disorder) {
  Field u = randomField(lattice, disorder, 3);
  for (uint32_t slot : lattice.active) u[slot] += (factor - 1) * lattice.restPosition(slot);
  return u;
}

}  // namespace

TEST(ReferenceForces, AreTheSlopeOfTheEnergy) {
  const Model model = modelOf({unitBody({3, 2, 2})});
  const ReferenceLattice lattice(model);
  EXPECT_LT(forceError(lattice, randomField(lattice, 0.3, 1), 1.0), kAgreement);
  EXPECT_LT(forceError(lattice, blownUp(lattice, 1.6, 0.05), 1.0), kAgreement);
  EXPECT_LT(forceError(lattice, blownUp(lattice, -0.6, 0.05), 1.0), kAgreement) << "inside out";
}

TEST(ReferenceForces, HaveTheStiffnessMatrixForTheirSlope) {
  const Model model = modelOf({unitBody({2, 2, 2})});
  const ReferenceLattice lattice(model);
  EXPECT_LT(stiffnessError(lattice, randomField(lattice, 0.25, 1), 1.0), kAgreement);
  EXPECT_LT(stiffnessError(lattice, blownUp(lattice, 1.6, 0.05), 1.0), kAgreement);
}

TEST(ReferenceForces, HaveAPositiveNeighborOfTheStiffnessMatrix) {
  const Model model = modelOf({unitBody({2, 2, 2})});
  const ReferenceLattice lattice(model);
  const Eigen::MatrixXd k =
      lattice.stiffnessMatrix(randomField(lattice, 0.4, 7), ReferenceLattice::Curvature::kPositive);
  const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k).eigenvalues();
  EXPECT_GT(eigenvalues.minCoeff(), -1e-12 * eigenvalues.maxCoeff());  // rounding
}

TEST(ReferenceForces, VanishUnderRigidMotion) {
  const Model model = modelOf({unitBody({3, 2, 4})});
  const ReferenceLattice lattice(model);
  const Quaterniond turn = rotationFromDegrees({35, -50, 110});
  Field u(lattice.slots(), Vector3d::Zero());
  for (uint32_t slot : lattice.active) {
    u[slot] = turn * lattice.restPosition(slot) + Vector3d(1.5, -2, 0.7) - lattice.restPosition(slot);
  }
  for (const Vector3d& force : lattice.elasticForces(u)) {
    EXPECT_LT(force.norm(), 1e-12);  // k h: rounding
  }
}

TEST(ReferenceParts, ForcesAreTheSlopeOfTheEnergy) {
  for (Weights weights : {Weights::kCell, Weights::kPaper}) {
    const Model model = modelOf({unitBody({1, 2, 1}), patchworkBody(weights)});
    const ReferenceLattice lattice(model);
    EXPECT_LT(forceError(lattice, randomField(lattice, 0.1, 1), 0.5), kAgreement);
    EXPECT_LT(stiffnessError(lattice, randomField(lattice, 0.1, 2), 0.5), kAgreement);
  }
}

TEST(ReferenceParts, TakeStiffnessAndMassFromTheCellsAround) {
  Body body = unitBody({2, 1, 1});
  body.lattice.part_names = {"left", "right"};
  body.lattice.cell_labels[slotAt(body, 1, 0, 0)] = 2;
  body.parts = {{"right", 6, 0.25, 5}};
  const Model model = modelOf({body});
  const ReferenceLattice lattice(model);
  const Elasticity left = elasticity(2.5, 0.25, 1, 1), right = elasticity(6, 0.25, 5, 1);
  constexpr double kFloat = 1e-6;  // strengths are float32
  EXPECT_NEAR(lattice.stiffness(slotAt(body, 1, 0, 0), 2), (left.spring_n_per_m + right.spring_n_per_m) / 4, kFloat);
  EXPECT_NEAR(lattice.stiffness(slotAt(body, 1, 1, 0), 3), (left.spring_n_per_m + right.spring_n_per_m) / 4, kFloat);
  EXPECT_NEAR(lattice.stiffness(slotAt(body, 1, 0, 0), 0), right.spring_n_per_m / 4, kFloat);
  EXPECT_NEAR(lattice.mass(slotAt(body, 0, 0, 0)), 1 / 8.0, kFloat);
  EXPECT_NEAR(lattice.mass(slotAt(body, 1, 0, 0)), 6 / 8.0, kFloat);
}

TEST(ReferenceCells, DieWithAnyOfTheirSprings) {
  const Body body = ofLaw(unitBody({3, 3, 3}));
  const Model model = modelOf({body});
  const uint32_t middle = slotAt(body, 1, 1, 1);
  for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
    ReferenceLattice lattice(model);
    const auto cells = [&] {
      int alive = 0;
      for (uint32_t slot : lattice.active) alive += (lattice.nodes[slot].lo & layout::kCellBit) != 0;
      return alive;
    };
    ASSERT_EQ(cells(), 27);
    lattice.eraseSpring(middle, spring);
    EXPECT_EQ(cells(), isAxial(spring) ? 27 - 4 : 27 - 2) << "spring " << spring;
    EXPECT_EQ(lattice.stiffness(middle, spring), 0);
    EXPECT_EQ(lattice.stiffness(lattice.farEnd(middle, spring), oppositeSpring(spring)), 0);
    EXPECT_LT(forceError(lattice, randomField(lattice, 0.2, 5), 1.0), kAgreement);
  }
}

}  // namespace viscera
