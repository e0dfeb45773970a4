// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ticks/stable_step.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "solver/tissue/joined_lattice.h"
#include "solver/tissue/substeps.h"
#include "support/backends.h"
#include "support/lattices.h"
#include "support/random_state.h"
#include "support/text.h"
#include "viscera/math/error.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kStableStepSpacing_m = 0.01;
constexpr double kNotLonger = 1e-3;              // of the true limit: float32 forces, and their nonlinear part
constexpr double kShorter = 0.02;                // of it: error of twenty products of Lanczos' method, on the safe side
constexpr double kStableStepEnergyBound = 1.01;  // of the initial energy, at the end of any tick

Body block(int cells = 4) {
  return boxBody(Vector3i::Constant(cells), kStableStepSpacing_m);
}

/// Returns 2 / omega_max of tissue at rest, from the reference's stiffness matrix.
double trueLimit_s(const Model& model) {
  const ReferenceSolver reference(model, Vector3d::Zero(), 1e-4);
  const Eigen::MatrixXd stiffness = reference.stiffnessMatrix();
  const Strengths strengths = allStrengths(model);
  Eigen::VectorXd per_root = Eigen::VectorXd::Zero(stiffness.rows());
  for (const uint32_t slot : activeSlots(model)) {
    if (isFixed(allNodes(model)[slot])) continue;
    per_root.segment<3>(reference.dof(slot, 0))
        .setConstant(1 / std::sqrt(static_cast<double>(strengths.mass_kg[slot])));
  }
  const Eigen::MatrixXd scaled = per_root.asDiagonal() * stiffness * per_root.asDiagonal();
  return 2 /
         std::sqrt(
             Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff());
}

Scene usual() {
  Scene scene;
  scene.environment.gravity_m_per_s2 = Vector3d::Zero();
  return scene;
}

/// Returns a state with the tissue stretched along x by this share.
HostState stretched(const Model& model, float share) {
  HostState state = restState(model);
  const Lattice& lattice = model.bodies[0].lattice;
  for (const uint32_t slot : lattice.active_slots) {
    if (!isFixed(lattice.nodes[slot]))
      state.displacement_m[slot].x = share * static_cast<float>(lattice.restPosition(slot).x());
  }
  return state;
}

uint64_t substepsOfATick(TissueStepper& solver) {
  const uint64_t before = solver.substepsDone();
  solver.step({});
  return solver.substepsDone() - before;
}

class MeasuredLimit : public OnBackend {};

INSTANTIATE_TEST_SUITE_P(Backends, MeasuredLimit, ::testing::ValuesIn(backendKinds()), backendSuffix);

}  // namespace

TEST_P(MeasuredLimit, IsThatOfTheFastestMode) {
  std::vector<Model> models;
  models.push_back(modelOf({block()}));
  for (const double nu : {0.25, 0.45, 0.49}) models.push_back(modelOf({ofLaw(block(), nu)}));
  models.push_back(modelOf({block(1), ofLaw(block(3))}));
  models.push_back(
      modelOf({momentBody({3, 3, 3}, kStableStepSpacing_m, [](const Vector3d& x) { return x.z() < 2.3; })}));
  for (size_t i = 0; i < models.size(); ++i) {
    SCOPED_TRACE(i);
    const auto solver = make(models[i], usual());
    const double limit_s = trueLimit_s(models[i]);
    EXPECT_LT(solver->dtLimit_s(), (1 + kNotLonger) * limit_s);
    EXPECT_GT(solver->dtLimit_s(), (1 - kShorter) * limit_s);
  }
}

TEST_P(MeasuredLimit, MakesSubstepsLongerByHalfAndMore) {
  constexpr double kGain = 1.6;  // as required by issue 15
  for (const Body& body : {block(8), ofLaw(block(8), 0.25), ofLaw(block(8), 0.49)}) {
    const Model model = modelOf({body});
    Scene scene = usual();
    scene.solver.tick_hz = 1;  // many substeps, so their rounding to integers does not matter
    scene.solver.max_substeps = 1000000;
    const double measured_s = make(model, scene)->dt_s();
    scene.solver.measured_limit = false;
    EXPECT_GT(measured_s, kGain * make(model, scene)->dt_s())
        << static_cast<int>(body.material.law) << ", nu " << body.material.poisson_ratio;
  }
}

TEST_P(MeasuredLimit, DecidesWhetherASceneNeedsTooManySubsteps) {
  const Model model = modelOf({block(8)});
  Scene scene = usual();
  scene.solver.max_substeps = 1000000;
  scene.solver.tick_hz = 10;
  const int measured = make(model, scene)->substeps();
  ASSERT_LT(measured, planSubsteps(model, scene.solver, safeTimeStep(model)).calm);
  scene.solver.max_substeps = measured;
  EXPECT_EQ(make(model, scene)->substeps(), measured);
  scene.solver.max_substeps = measured - 1;
  EXPECT_TRUE(says(messageOf<SceneError>([&] { make(model, scene); }), {"measured stable substep"}));
  scene.solver.max_substeps = measured;
  scene.solver.measured_limit = false;
  EXPECT_THROW(make(model, scene), SceneError);
}

TEST_P(MeasuredLimit, LeavesTheStateAtRest) {
  const Model model = modelOf({block()});
  const auto solver = make(model, usual());
  EXPECT_EQ(stateHash(model, solver->readState()), stateHash(model, restState(model)));
  solver->step({});
  EXPECT_EQ(stateHash(model, solver->readState()), stateHash(model, restState(model)));
}

TEST_P(MeasuredLimit, IsNotTakenWhereSomethingElseDecides) {
  const Model model = modelOf({block()});
  for (const int what : {0, 1, 2, 3}) {
    Scene scene = usual();
    if (what == 0) scene.solver.measured_limit = false;
    if (what == 1) scene.solver.stability_monitor = false;
    if (what == 2) scene.solver.substeps = 100;
    if (what == 3) scene.solver.integrator = Integrator::kPd;
    const auto solver = make(model, scene);
    EXPECT_EQ(solver->dtLimit_s(), solver->dtSafe_s()) << what;
    EXPECT_EQ(solver->substeps(), planSubsteps(model, scene.solver, safeTimeStep(model)).calm) << what;
  }
}

TEST_P(MeasuredLimit, SubstepsAreShorterWhereTissueIsStrained) {
  const Model model = modelOf({block()});
  Scene scene = usual();
  scene.solver.tick_hz = 10;
  const auto solver = make(model, scene);
  const uint64_t calm = substepsOfATick(*solver);
  EXPECT_EQ(calm, static_cast<uint64_t>(solver->substeps()));
  solver->writeState(stretched(model, 0.45f));
  const double factor = static_cast<double>(substepsOfATick(*solver)) / static_cast<double>(calm);
  EXPECT_NEAR(factor, strainFactor(0.4), 2.0 / static_cast<double>(calm));  // of 0.45, rounded down; whole substeps
}

/// Nodes at random positions, with the default dashpot.
TEST_P(MeasuredLimit, IsStable) {
  for (const Body& body : {block(), ofLaw(block(), 0.49)}) {
    SCOPED_TRACE(static_cast<int>(body.material.law));
    const Model model = modelOf({body});
    const auto solver = make(model, usual());
    for (const double amplitude : {0.01, 0.1, 0.3}) {
      const HostState start = randomState(model, amplitude * kStableStepSpacing_m, 0, 5);
      const double start_j = energyOf(model, start);
      solver->reset();
      solver->writeState(start);
      for (int t = 0; t < 60; ++t) solver->step({});
      EXPECT_LT(energyOf(model, solver->readState()), 0.1 * start_j) << amplitude;
      EXPECT_EQ(solver->health().trips, 0u) << amplitude;
    }
  }
}
