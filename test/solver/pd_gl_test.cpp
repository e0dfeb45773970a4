// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/implicit.h"

using namespace viscera;
using namespace viscera::test;

namespace {

// Relative to the largest value, after kSubsteps of 3 dt_safe with iterations enough that more change nothing: float32
// rounding of increments and of their sum.
constexpr double kConverged = 2e-6;
constexpr int kIterations = 160;
constexpr int kSubsteps = 3;

class Pd : public OnBackend {
 protected:
  void expectLikeReference(const Model& model, const Vector3d& gravity) {
    const auto solver = make(model, sceneWith(Integrator::kPd, model, kSubsteps, 3, kIterations, {}, gravity));
    const HostState start = randomState(model, 0.05 * model.bodies[0].lattice.spacing_m, 0.1, 7);
    solver->writeState(start);
    ReferenceSolver reference = referenceFor(ReferenceIntegrator::kImplicitEuler, model, *solver, start, gravity);
    solver->step({});
    for (int s = 0; s < kSubsteps; ++s) reference.substep();
    const HostState end = solver->readState();
    EXPECT_LT(relativeError(end.displacement_m, reference.u_m, reference.active), kConverged);
    EXPECT_LT(relativeError(end.velocity_m_per_s, reference.v_m_per_s, reference.active), kConverged);
  }
};

INSTANTIATE_TEST_SUITE_P(Backends, Pd, ::testing::ValuesIn(backendKinds()), backendSuffix);

}  // namespace

TEST_P(Pd, MatchesReferenceAtEverySize) {
  for (size_t size : kSizes) {
    if (size > 100) continue;  // a random tree of 1234 nodes hangs together by single springs: thousands of iterations
    SCOPED_TRACE(size);
    Body body = blobBody(size, 0.01, 3);
    body.material.drag_per_s = 50;
    expectLikeReference(modelOf({body}), Vector3d(0.3, -0.2, -9.81));
  }
}

TEST_P(Pd, MatchesReferenceWithVolumesOfAnyPoissonRatio) {
  for (const double poisson_ratio : {0.0, 0.45, 0.49}) {
    SCOPED_TRACE(poisson_ratio);
    Body body = boxBody({4, 4, 4}, 0.01);
    body.material.poisson_ratio = poisson_ratio;
    expectLikeReference(modelOf({body}), Vector3d(0, 0, -9.81));
  }
}

TEST_P(Pd, MatchesReferenceWithMoments) {
  for (const Body& body : momentBodies()) expectLikeReference(modelOf({body}), Vector3d(0, 0, -9.81));
}

TEST_P(Pd, EnergyStaysBelowItsStartWithMoments) {
  expectEnergyBoundWithMoments(GetParam(), Integrator::kPd);
}

TEST_P(Pd, MatchesReferenceWithPartsAndFixedNodes) {
  expectLikeReference(modelOf({twoPartBody()}), Vector3d(0, 0, -9.81));
}

TEST_P(Pd, EnergyStaysBelowItsStartWhateverTheStart) {
  for (const double poisson_ratio : {0.25, 0.45}) {
    for (const double fraction : {1.0, 10.0, 100.0})
      expectEnergyBound(GetParam(), Integrator::kPd, poisson_ratio, fraction);
  }
  expectEnergyBound(GetParam(), Integrator::kPd, 0.49,
                    0.5);  // too few sweeps: without the bound at the end of a substep 1.4 of the start
}

/// One sweep is far from a solution: what it leaves of the velocities has more energy than the start, and is not taken.
TEST_P(Pd, EnergyStaysBelowItsStartWithTooFewIterations) {
  expectEnergyBound(GetParam(), Integrator::kPd, 0.49, 0.2, 1);  // 1.09 of its start where the last share is not chosen
}

TEST_P(Pd, FallsFreelyHoweverLongTheSubstep) {
  const Model model = modelOf({boxBody({3, 3, 3}, 0.01)});
  const auto solver = make(model, sceneWith(Integrator::kPd, model, 4, 30, 5, {}, Vector3d(0, 0, -9.81)));
  ReferenceSolver reference =
      referenceFor(ReferenceIntegrator::kImplicitEuler, model, *solver, restState(model), Vector3d(0, 0, -9.81));
  solver->step({});
  for (int s = 0; s < 4; ++s) reference.substep();
  EXPECT_LT(relativeError(solver->readState().displacement_m, reference.u_m, reference.active), kConverged);
}

TEST_P(Pd, ToolsActLikeTheReferences) {
  for (const double poisson_ratio : {0.25, 0.4}) {
    // Absolute positions of tools, rounded at 6e-8 of 0.05 m, on displacements of 3e-3 m.
    expectToolsLikeReference(GetParam(), Integrator::kPd, kIterations, poisson_ratio, 1e-5);
  }
}
