// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The neo-Hookean law in float64, against what is known of it.
#include <cmath>

#include "solver/reference/derivatives.h"
#include "support/lattices.h"
#include "support/random_state.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kLawBlockSpacing_m = 0.01, kNu = 0.3, kBulkOverMu = 2.0 / 3 + 2 * kNu / (1 - 2 * kNu);

Model lawBlockModel() {
  Body body = boxBody({3, 3, 3}, kLawBlockSpacing_m);
  body.material.cells = Cells::kMoments;
  body.material.law = Law::kNeoHookean;
  body.material.poisson_ratio = kNu;
  return modelOf({body});
}

/// u = (F - 1) x of all nodes.
Field affine(const Model& model, const ReferenceLattice& lattice, const Eigen::Matrix3d& f) {
  Field out(model.slots(), Vector3d::Zero());
  for (const uint32_t slot : lattice.active) out[slot] = (f - Eigen::Matrix3d::Identity()) * lattice.restPosition(slot);
  return out;
}

double density(const Eigen::Matrix3d& f) {
  const double j = f.determinant();
  return 0.5 * (std::pow(j, -2.0 / 3) * f.squaredNorm() - 3) + 0.25 * kBulkOverMu * (j * j - 1 - 2 * std::log(j));
}

}  // namespace

TEST(Law, AnAffineMotionHasTheEnergyOfItsGradient) {
  const Model model = lawBlockModel();
  const ReferenceLattice lattice(model);
  const double mu = model.bodies[0].material.young_modulus_pa / (2 * (1 + kNu));
  Eigen::Matrix3d f;
  f << 1.3, 0.2, -0.1, 0.05, 0.8, 0.3, 0.1, -0.2, 1.1;
  const double volume = 27 * kLawBlockSpacing_m * kLawBlockSpacing_m * kLawBlockSpacing_m;
  constexpr double kOfFloatConstants = 1e-6;
  EXPECT_NEAR(lattice.elasticEnergy(affine(model, lattice, f)), mu * volume * density(f),
              kOfFloatConstants * mu * volume * density(f));
  EXPECT_NEAR(lattice.springEnergy(affine(model, lattice, f)), 0, 0);
}

TEST(Law, ForcesAndStiffnessAreDerivativesOfTheEnergy) {
  Body ball = momentBody({3, 3, 3}, kLawBlockSpacing_m,
                         [](const Vector3d& p) { return (p - Vector3d(1.6, 1.4, 1.5)).norm() < 1.3; });
  ball.material.law = Law::kNeoHookean;
  ball.material.poisson_ratio = kNu;
  Body stiffening = ball;
  stiffening.material.stiffening = 4;
  for (const Model& model : {lawBlockModel(), modelOf({ball}), modelOf({stiffening})}) {
    const ReferenceLattice lattice(model);
    for (const double size : {0.05, 0.3, 1.0}) {
      const HostState state = randomState(model, size * kLawBlockSpacing_m, 0, 5);
      Field u(model.slots(), Vector3d::Zero());
      for (const uint32_t slot : lattice.active) u[slot] = xyz(state.displacement_m[slot]);
      EXPECT_LT(forceError(lattice, u, kLawBlockSpacing_m), kAgreement) << size;
      EXPECT_LT(stiffnessError(lattice, u, kLawBlockSpacing_m), kAgreement) << size;
    }
  }
}
