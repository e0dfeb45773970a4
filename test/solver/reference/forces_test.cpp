// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "solver/reference/derivatives.h"
#include "solver/reference/reference_bodies.h"
#include "solver/reference/volume_energy.h"

namespace viscera {
namespace {

using namespace test;

/// Blows the body up: with a factor of 1.6 a cell's volume has grown by more than itself.
Field blownUp(const ReferenceLattice& lattice, double factor, double disorder) {
  Field u = randomField(lattice, disorder, 3);
  for (uint32_t slot : lattice.active) u[slot] += (factor - 1) * lattice.restPosition(slot);
  return u;
}

class ReferenceForces : public ::testing::TestWithParam<double> {};

}  // namespace

TEST_P(ReferenceForces, AreTheSlopeOfTheEnergy) {
  const Model model = modelOf({unitBody({3, 2, 2}, GetParam())});
  const ReferenceLattice lattice(model);
  EXPECT_LT(forceError(lattice, randomField(lattice, 0.3, 1), 1.0), kAgreement);
  EXPECT_LT(forceError(lattice, blownUp(lattice, 1.6, 0.05), 1.0), kAgreement) << "beyond |e| = 1";
  EXPECT_LT(forceError(lattice, blownUp(lattice, -0.6, 0.05), 1.0), kAgreement) << "inside out";
}

TEST_P(ReferenceForces, HaveTheStiffnessMatrixForTheirSlope) {
  const Model model = modelOf({unitBody({2, 2, 2}, GetParam())});
  const ReferenceLattice lattice(model);
  EXPECT_LT(stiffnessError(lattice, randomField(lattice, 0.25, 1), 1.0), kAgreement);
  EXPECT_LT(stiffnessError(lattice, blownUp(lattice, 1.6, 0.05), 1.0), kAgreement);
}

TEST_P(ReferenceForces, HaveAPositiveNeighborOfTheStiffnessMatrix) {
  const Model model = modelOf({unitBody({2, 2, 2}, GetParam())});
  const ReferenceLattice lattice(model);
  const Eigen::MatrixXd k =
      lattice.stiffnessMatrix(randomField(lattice, 0.4, 7), ReferenceLattice::Curvature::kPositive);
  const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k).eigenvalues();
  EXPECT_GT(eigenvalues.minCoeff(), -1e-12 * eigenvalues.maxCoeff());  // rounding
}

TEST_P(ReferenceForces, VanishUnderRigidMotion) {
  const Model model = modelOf({unitBody({3, 2, 4}, GetParam())});
  const ReferenceLattice lattice(model);
  const Quaterniond turn = rotationFromDegrees({35, -50, 110});
  Field u(lattice.slots(), Vector3d::Zero());
  for (uint32_t slot : lattice.active) {
    u[slot] = turn * lattice.restPosition(slot) + Vector3d(1.5, -2, 0.7) - lattice.restPosition(slot);
  }
  for (const Vector3d& force : lattice.elasticForces(u)) {
    EXPECT_LT(force.norm(), 1e-12);  // k h: rounding, times lambda_V / mu = 48 at nu = 0.49
  }
}

INSTANTIATE_TEST_SUITE_P(PoissonRatios, ReferenceForces, ::testing::Values(0.0, 0.25, 0.4, 0.49));

TEST(ReferenceParts, ForcesAreTheSlopeOfTheEnergy) {
  for (Weights weights : {Weights::kCell, Weights::kPaper}) {
    const Model model = modelOf({unitBody({1, 2, 1}, 0.4), patchworkBody(weights)});
    const ReferenceLattice lattice(model);
    EXPECT_LT(forceError(lattice, randomField(lattice, 0.1, 1), 0.5), kAgreement);
    EXPECT_LT(stiffnessError(lattice, randomField(lattice, 0.1, 2), 0.5), kAgreement);
  }
}

TEST(ReferenceParts, TakeStiffnessMassAndVolumeFromTheCellsAround) {
  Body body = unitBody({2, 1, 1});
  body.lattice.part_names = {"left", "right"};
  body.lattice.cell_labels[slotAt(body, 1, 0, 0)] = 2;
  body.parts = {{"right", 6, 0.49, 5}};
  const Model model = modelOf({body});
  const ReferenceLattice lattice(model);
  const Elasticity left = elasticity(2.5, 0.25, 1, 1), right = elasticity(6, 0.49, 5, 1);
  constexpr double kFloat = 1e-6;  // strengths are float32
  EXPECT_NEAR(lattice.stiffness(slotAt(body, 1, 0, 0), 2), (left.spring_n_per_m + right.spring_n_per_m) / 4, kFloat);
  EXPECT_NEAR(lattice.stiffness(slotAt(body, 1, 1, 0), 3), (left.spring_n_per_m + right.spring_n_per_m) / 4, kFloat);
  EXPECT_NEAR(lattice.stiffness(slotAt(body, 1, 0, 0), 0), right.spring_n_per_m / 4, kFloat);
  EXPECT_NEAR(lattice.mass(slotAt(body, 0, 0, 0)), 1 / 8.0, kFloat);
  EXPECT_NEAR(lattice.mass(slotAt(body, 1, 0, 0)), 6 / 8.0, kFloat);
  EXPECT_EQ(lattice.bulk(slotAt(body, 0, 0, 0)), 0);
  EXPECT_NEAR(lattice.bulk(slotAt(body, 1, 0, 0)), right.bulk_j, 1e-6 * right.bulk_j);
  EXPECT_EQ(lattice.bulk(slotAt(body, 2, 0, 0)), 0);
}

TEST(ReferenceCells, DieWithAnyOfTheirSprings) {
  const Body body = unitBody({3, 3, 3}, 0.4);
  const Model model = modelOf({body});
  const uint32_t middle = slotAt(body, 1, 1, 1);
  for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
    ReferenceLattice lattice(model);
    const auto cells = [&] {
      int alive = 0;
      for (uint32_t slot : lattice.active) alive += lattice.bulk(slot) > 0;
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

TEST(VolumeEnergy, HasBoundedPressureAndIsBoundedBelow) {
  EXPECT_DOUBLE_EQ(volumeEnergy(2, 0.5), 0.25);
  EXPECT_DOUBLE_EQ(volumeEnergy(2, 3), 5);
  EXPECT_DOUBLE_EQ(volumeEnergy(2, -3), 5);
  EXPECT_DOUBLE_EQ(volumeSlope(2, 100), 2);
  EXPECT_DOUBLE_EQ(volumeSlope(2, -100), -2);
  EXPECT_DOUBLE_EQ(volumeEnergy(-2, 1), -1);
  EXPECT_NEAR(volumeEnergy(-2, 1e9), -1, 1e-8);
  for (double e = -5; e < 100; e += 0.01) EXPECT_GT(volumeEnergy(-2, e), -1.46);  // g is largest at e = 1 + sqrt 2
  EXPECT_NEAR(volumeEnergy(-2, 1e-4), -1e-8, 3e-12);                              // e^2 (1 + 2 e + ...)
  EXPECT_EQ(volumeEnergy(-2, -2), 0) << "a mirrored cell must not gain";
}

}  // namespace viscera
