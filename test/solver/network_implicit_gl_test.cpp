// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// pd and verlet_paper with explicit connections, against the reference.
#include "solver/network_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

// Relative to the largest value, with enough iterations to converge: float32 rounding of increments and of their sum,
// as for lattices (pd_gl_test.cpp).
constexpr double kConverged = 2e-6;
constexpr int kIterations = 200;
constexpr int kNetworkImplicitSubsteps = 3;
// Roundings of a position per substep of verlet_paper, each up to 2^-24 of it: as for lattices
// (verlet_paper_gl_test.cpp), plus one for every hundred links of a hub.
constexpr double kRounding = 1.0 / (1 << 24);
constexpr double kRoundingsPerSubstep = 6;

class NetworkIntegrators : public OnBackend {
 protected:
  void expectImplicitEuler(const Model& model) {
    const Vector3d gravity(0.3, -0.2, -9.81);
    const auto solver =
        make(model, sceneWith(Integrator::kPd, model, kNetworkImplicitSubsteps, 3, kIterations, {}, gravity));
    const HostState start = scatteredState(model, 5e-4, 0.1, 7);
    ReferenceSolver reference = referenceFor(ReferenceIntegrator::kImplicitEuler, model, *solver, start, gravity);
    expectSameTick(*solver, reference, start, kConverged, kConverged);
  }
};

INSTANTIATE_TEST_SUITE_P(Backends, NetworkIntegrators, ::testing::ValuesIn(backendKinds()), backendSuffix);

/// Returns a graph: pieces connected by single springs; valences from 1 to 200.
Body knot(size_t nodes, double prestrain) {
  GraphOptions options;
  options.prestrain = prestrain;
  return graphBody(nodes, 6 * nodes, 3, options);
}

}  // namespace

TEST_P(NetworkIntegrators, PdSolvesImplicitEulerOnGraphs) {
  for (size_t size : {size_t{1}, size_t{2}, size_t{63}, size_t{64}, size_t{65}}) {
    SCOPED_TRACE(size);
    expectImplicitEuler(modelOf({knot(size, 0.02)}));
  }
}

TEST_P(NetworkIntegrators, PdSolvesImplicitEulerOnClothAndLatticesOfLinks) {
  Body cloth = clothBody(8, 9, 0.01);
  fixNearest(cloth, {{-1, -1, 0}, {1, 1, 0}});
  const Body box = boxBody({4, 4, 3}, 0.01);
  expectImplicitEuler(modelOf({cloth}));
  expectImplicitEuler(modelOf({withLinks(box)}));
  expectImplicitEuler(modelOf({withLinks(twoPartBody())}));
  expectImplicitEuler(modelOf({box, cloth, knot(64, 0.02)}));
}

TEST_P(NetworkIntegrators, PdKeepsEnergyBelowItsStartFromWildStarts) {
  constexpr double kAllowed = 0.01;  // of the start: the stability suite's limit
  const Model model = modelOf({undamped(clothBody(7, 7, 0.01)), undamped(knot(100, 0))});
  for (double fraction : {1.0, 10.0, 100.0}) {
    SCOPED_TRACE(fraction);
    const auto solver = make(model, sceneWith(Integrator::kPd, model, 1, fraction, 20));
    const HostState start = scatteredState(model, 0.1, 10, 5);  // ten times the length of the cloth's springs
    solver->writeState(start);
    const double start_j = energyOf(model, start);
    for (int t = 0; t < 8; ++t) {
      solver->step({});
      const HostState state = solver->readState();
      ASSERT_TRUE(isFinite(state.displacement_m) && isFinite(state.velocity_m_per_s)) << "tick " << t;
      ASSERT_LE(energyOf(model, state), (1 + kAllowed) * start_j) << "tick " << t;
    }
    EXPECT_LT(energyOf(model, solver->readState()), 0.7 * start_j) << "standing still is no stability";
  }
}

TEST_P(NetworkIntegrators, VerletPaperFollowsTheReference) {
  constexpr int kTick = 10;
  for (const Model& model : {modelOf({knot(65, 0.05)}), mixedModel()}) {
    const Vector3d gravity(0.3, -0.2, -9.81);
    const auto solver = make(model, sceneWith(Integrator::kVerletPaper, model, kTick, 0.5, 1, {}, gravity));
    const HostState start = scatteredState(model, 5e-4, 0.1, 7);
    solver->writeState(start);
    ReferenceSolver reference = referenceFor(ReferenceIntegrator::kVerletPaper, model, *solver, start, gravity);
    solver->step({});
    for (int s = 0; s < kTick; ++s) reference.substep();
    const HostState end = solver->readState();
    double farthest_m = 0, error_m = 0;
    for (uint32_t slot : reference.active) {
      farthest_m = std::max(farthest_m, reference.restPosition(slot).cwiseAbs().maxCoeff());
      error_m = std::max(error_m, (xyz(end.displacement_m[slot]) - reference.u_m[slot]).norm());
    }
    EXPECT_LT(error_m, kRoundingsPerSubstep * kRounding * farthest_m * kTick * (kTick + 1) / 2);
    EXPECT_LT(error_m, 1e-3 * 5e-4) << "of what the nodes were moved: that bound must mean something";
  }
}
