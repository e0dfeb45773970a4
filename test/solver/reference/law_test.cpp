// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The neo-Hookean law in float64, against known solutions.
#include <Eigen/Geometry>
#include <cmath>

#include "model/fracture/prestress.h"
#include "solver/reference/derivatives.h"
#include "support/lattices.h"
#include "support/random_state.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kLawBlockSpacing_m = 0.01, kNu = 0.3, kBulkOverMu = 2.0 / 3 + 2 * kNu / (1 - 2 * kNu);

Model lawBlockModel() {
  return modelOf({ofLaw(boxBody({3, 3, 3}, kLawBlockSpacing_m), kNu)});
}

/// Returns u = (F - 1) x of all nodes.
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
  ball.material.poisson_ratio = kNu;
  Body stiffening = ball, stressed = ball;
  stiffening.material.stiffening = 4;
  stressed.prestress.assign(ball.lattice.nodes.size(), {0.3f, -0.1f, 0.2f, 0.1f, -0.2f, 0.05f});
  const Body layers =
      twoMaterials(ball, {0.3, 0.8, 0.5}, 1.5, {"stiff", 10 * ball.material.young_modulus_pa, 0.45, 1e3});
  for (const Model& model :
       {lawBlockModel(), modelOf({ball}), modelOf({stiffening}), modelOf({stressed}), modelOf({layers})}) {
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

/// Fixed everywhere, tissue keeps its whole prestress. Freed, it would be at rest shortened by the prescribed strain
/// along each axis.
TEST(Law, TissueThatIsFreedTakesTheShapeThatItsPrestressAsksFor) {
  constexpr double kOfFloatStress = 1e-6;  // of the force on one face of a cell
  PrestressConfig prestress;
  prestress.strain = 0.05;
  prestress.strains = {0.2, 0, -0.1};
  prestress.axes_deg = {20, 0, 30};
  const Eigen::Matrix3d turn = rotationFromDegrees(prestress.axes_deg).toRotationMatrix();
  const Eigen::Matrix3d shape = turn * Vector3d(1 - 0.25, 1 - 0.05, 1 + 0.05).asDiagonal() * turn.transpose();
  for (const double nu : {0.0, 0.3, 0.49}) {
    for (const double stiffening : {0.0, 4.0}) {
      Body body = ofLaw(boxBody({3, 4, 3}, kLawBlockSpacing_m), nu);
      body.material.stiffening = stiffening;
      body.material.prestress = prestress;
      for (const uint32_t slot : body.lattice.active_slots) body.lattice.nodes[slot].lo |= layout::kFixedBit;
      addCellPrestress(body);
      const Model model = modelOf({body});
      const ReferenceLattice lattice(model);
      const double mu = body.material.young_modulus_pa / (2 * (1 + nu));
      const double bears_n = mu * kLawBlockSpacing_m * kLawBlockSpacing_m;
      const Field held = lattice.elasticForces(Field(model.slots(), Vector3d::Zero()));
      const Field freed = lattice.elasticForces(affine(model, lattice, shape));
      double most_held_n = 0;
      for (const uint32_t slot : lattice.active) {
        EXPECT_LT(freed[slot].norm(), kOfFloatStress * bears_n / (1 - 2 * nu)) << nu << ", b " << stiffening;
        most_held_n = std::max(most_held_n, held[slot].norm());
      }
      EXPECT_GT(most_held_n, 0.05 * bears_n);
    }
  }
}

TEST(Law, RigidMotionHasNoEnergyAndTurningChangesNone) {
  constexpr double kRounding = 1e-12;  // of the energy of the same strain
  const Body cut =
      momentBody({3, 3, 3}, kLawBlockSpacing_m, [](const Vector3d& p) { return p.dot(Vector3d(1, 0.7, 0.4)) < 3.1; });
  const Model model = modelOf({twoMaterials(cut, {0.3, 0.8, 0.5}, 1.5, {"stiff", 1e5, 0.45, 1e3})});
  const ReferenceLattice lattice(model);
  const HostState state = randomState(model, 0.1 * kLawBlockSpacing_m, 0, 5);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  Field u(model.slots(), Vector3d::Zero()), turned = u, rigid = u;
  for (const uint32_t slot : lattice.active) {
    const Vector3d x = lattice.restPosition(slot);
    u[slot] = xyz(state.displacement_m[slot]);
    turned[slot] = turn * (x + u[slot]) - x + Vector3d(0.1, 0, 0.3);
    rigid[slot] = turn * x - x;
  }
  const double energy_j = lattice.elasticEnergy(u);
  EXPECT_GT(energy_j, 0);
  EXPECT_NEAR(lattice.elasticEnergy(turned), energy_j, kRounding * energy_j);
  EXPECT_NEAR(lattice.elasticEnergy(rigid), 0, kRounding * energy_j);
}

/// A full cell bends as a plate and twists as a bar: E h / (6 (1 - nu^2)) [[1, nu], [nu, 1]], and mu h/3 with mu h/6 as
/// the coupling.
TEST(Law, OneCellBendsAndTwistsAsTheSolidDoes) {
  constexpr double kSmall = 1e-4;  // of the spacing: larger strains show second-order terms
  for (const double nu : {0.0, 0.25, 0.45}) {
    const Body body = ofLaw(boxBody({1, 1, 1}, kLawBlockSpacing_m), nu);
    const Model model = modelOf({body});
    const ReferenceLattice lattice(model);
    const double young = body.material.young_modulus_pa, mu = young / (2 * (1 + nu)), h = kLawBlockSpacing_m;
    const auto energy = [&](double bend_x, double bend_y, double twist) {
      Field u(model.slots(), Vector3d::Zero());
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

/// A plate of cells that are half filled from below: the bending part is half a cell thick, and bends about its own
/// middle.
TEST(Law, TissueOnOneSideOfACellBendsAboutItsOwnMiddle) {
  constexpr double kBend = 3e-5;         // of the spacing: larger strains show second-order terms
  constexpr double kSecondOrder = 1e-3;  // remaining second-order terms
  constexpr int kLength = 4;             // [cells]
  const Body body = momentBody({kLength, 1, 1}, kLawBlockSpacing_m, [](const Vector3d& p) { return p.z() < 0.5; });
  const Model model = modelOf({body});
  const ReferenceLattice lattice(model);
  const double h = kLawBlockSpacing_m, young = body.material.young_modulus_pa, nu = body.material.poisson_ratio;
  const auto energy = [&](double middle) {
    Field u(model.slots(), Vector3d::Zero());
    for (const uint32_t slot : lattice.active) {
      const Vector3d p = lattice.restPosition(slot) / h - Vector3d(0.5 * kLength, 0.5, 0);
      const double thinned = nu / (1 - nu) * (0.5 - middle) * p.z();  // by the mean strain of the cell
      u[slot] = h * kBend * Vector3d(p.x() * (p.z() - middle), 0, -0.5 * p.x() * p.x() - thinned);
    }
    return lattice.elasticEnergy(u) / (kLength * h * h * h * kBend * kBend);
  };
  const double plate = young / (1 - nu * nu) / 2, of_itself = 0.125 / 12;
  EXPECT_NEAR(energy(0.25) / (plate * of_itself), 1, kSecondOrder);
  EXPECT_NEAR(energy(0.5) / (plate * (of_itself + 0.5 * 0.25 * 0.25)), 1, kSecondOrder);
}

/// Sides fixed: resistance increases until a fifth of the volume is left, and from there it is still pushed open.
TEST(Law, ASqueezedCellResistsEverMoreAndIsNeverTurnedInsideOutForNothing) {
  for (const double nu : {0.0, 0.25, 0.45}) {
    const Model model = modelOf({ofLaw(boxBody({1, 1, 1}, kLawBlockSpacing_m), nu)});
    const ReferenceLattice lattice(model);
    const auto squeezed = [&](double by) {
      return lattice.elasticEnergy(affine(model, lattice, Eigen::Matrix3d(Vector3d(1, 1, 1 - by).asDiagonal())));
    };
    const auto force = [&](double by) {
      constexpr double kStep = 1e-4;
      return (squeezed(by + kStep) - squeezed(by - kStep)) / (2 * kStep);
    };
    double before = 0;
    for (int percent = 5; percent <= 75; percent += 5) {
      const double now = force(0.01 * percent);
      EXPECT_GT(now, before) << nu << ' ' << percent;
      before = now;
    }
    for (int percent = 80; percent <= 200; percent += 5) EXPECT_GT(force(0.01 * percent), 0) << nu << ' ' << percent;
  }
}
