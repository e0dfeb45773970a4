// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cells by moments on the backends, against the float64 reference.
#include "support/backends.h"
#include "support/random_state.h"
#include "tools/motion_packing.h"

using namespace viscera;
using namespace viscera::test;

namespace {

// Relative to the largest value: float32 rounds at 6e-8; a cell's forces are sums of some forty products on the way.
constexpr double kFloat32Displacement = 2e-6;
constexpr double kFloat32Velocity = 1e-5;
constexpr double kFloat32Energy = 2e-5;
constexpr double kSpacing_m = 0.01;

/// A ball off the lattice: full cells inside, all kinds of partial ones around.
Body ball() {
  return momentBody({8, 8, 8}, kSpacing_m,
                    [](const Vector3d& p) { return (p - Vector3d(4.1, 3.8, 4.3)).norm() < 3.3; });
}

Body block(const Vector3i& cells) {
  Body body = boxBody(cells, kSpacing_m);
  body.material.cells = Cells::kMoments;
  return body;
}

class Moments : public OnBackend {
 protected:
  void expectLikeReference(const Model& model, const Scene& scene, double size_m, int substeps) {
    const auto solver = make(model, scene);
    const HostState start = randomState(model, size_m, 0.1, 7);
    solver->writeState(start);
    ReferenceSolver reference(model, Vector3d(0.3, -0.2, -9.81), static_cast<float>(solver->dt_s()));
    load(reference, start);
    solver->step({});
    for (int s = 0; s < substeps; ++s) reference.substep();
    const HostState end = solver->readState();
    EXPECT_LT(relativeError(end.displacement_m, reference.u_m, reference.active), kFloat32Displacement);
    EXPECT_LT(relativeError(end.velocity_m_per_s, reference.v_m_per_s, reference.active), kFloat32Velocity);
  }
  void expectLikeReference(const Body& body, double size_m = 0.05 * kSpacing_m, int substeps = 10) {
    const Model model = modelOf({body});
    expectLikeReference(model, sceneFor(model, substeps, {}, Vector3d(0.3, -0.2, -9.81)), size_m, substeps);
  }
};

INSTANTIATE_TEST_SUITE_P(Backends, Moments, ::testing::ValuesIn(backendNames()), backendSuffix);

}  // namespace

TEST_P(Moments, FullCellsMatchTheReferenceForAnyPoissonRatio) {
  for (const double nu : {0.0, 0.25, 0.45, 0.49}) {
    SCOPED_TRACE(nu);
    Body body = block({5, 6, 9});
    body.material.poisson_ratio = nu;
    expectLikeReference(body);
  }
}

TEST_P(Moments, PartialCellsMatchTheReferenceForAnyPoissonRatio) {
  for (const double nu : {0.0, 0.25, 0.45, 0.49}) {
    SCOPED_TRACE(nu);
    Body body = ball();
    body.material.poisson_ratio = nu;
    expectLikeReference(body);
  }
}

TEST_P(Moments, StrainsThatFadeThemOutMatchTheReference) {
  for (const double size : {0.2, 0.5}) {
    SCOPED_TRACE(size);
    expectLikeReference(ball(), size * kSpacing_m, 1);
    expectLikeReference(block({4, 5, 6}), size * kSpacing_m, 1);
  }
}

TEST_P(Moments, PartsAndTornCellsMatchTheReference) {
  Body body = ball();
  body.lattice.part_names = {"wall", "valve"};
  for (uint32_t slot = 0; slot < body.lattice.nodes.size(); ++slot) {
    uint16_t& label = body.lattice.cell_labels[slot];
    if (label && body.lattice.nodeAt(slot).x() >= 4) label = 2;
  }
  body.parts = {{"valve", 100e3, 0.4, 3000}};
  body.lattice.nodes[static_cast<size_t>(body.lattice.slotAt({4, 4, 4}))].lo &= ~layout::kCellBit;
  expectLikeReference(body);
}

TEST_P(Moments, BodiesOfBothKindsMatchTheReference) {
  Body springs = boxBody({3, 4, 3}, kSpacing_m);
  springs.material.poisson_ratio = 0.4;
  const Model model = modelOf({springs, ball(), block({2, 3, 2})});
  expectLikeReference(model, sceneFor(model, 10, {}, Vector3d(0.3, -0.2, -9.81)), 0.05 * kSpacing_m, 10);
}

TEST_P(Moments, DashpotsAndSpringsOfAnyLengthMatchTheReference) {
  Body body = ball();
  body.material.dashpot_ratio = 0.2;
  expectLikeReference(body);
  expectLikeReference(body, 0.3 * kSpacing_m, 1);
}

TEST_P(Moments, CellsThatABladeCutsMatchTheReference) {
  constexpr int kSubsteps = 10;
  const Model model = modelOf({ball()});
  std::vector<StylusConfig> styluses(2);
  styluses[0].cut.blade_length_m = 0.2;
  styluses[0].cut.blade_side = BladeSide::kAhead;
  const auto solver = make(model, sceneFor(model, kSubsteps, styluses));
  const HostState start = randomState(model, 0.02 * kSpacing_m, 0.05, 7);
  solver->writeState(start);
  ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()));
  load(reference, start);
  const ToolActs acts(styluses, kSubsteps * solver->dt_s());
  ToolMotions motions;  // the blade points down and sweeps half way through the ball
  motions[0].mode = ToolMode::kCut;
  motions[0].present = true;
  motions[0].from.position_m = {-0.02, 0.0452, 0.16};
  motions[0].to.position_m = {0.043, 0.0452, 0.16};
  size_t cut = 0;
  for (int t = 0; t < 2; ++t) {
    solver->step(motions);
    acts.beginTick(reference, motions);
    std::vector<layout::ToolMotion> rows;
    interpolateMotions(motions, styluses, kSubsteps, rows);
    for (size_t s = 0; s < kSubsteps; ++s) reference.substep({rows[2 * s], rows[2 * s + 1]});
    acts.endTick(reference, motions);
    motions[0] = {};
  }
  const HostState end = solver->readState();
  for (const uint32_t slot : reference.active) {
    const layout::NodeBits &before = start.nodes[slot], &now = end.nodes[slot];
    cut += before.lo != now.lo || before.hi != now.hi ? 1 : 0;
  }
  EXPECT_GT(cut, 50u);
  EXPECT_LT(relativeError(end.displacement_m, reference.u_m, reference.active), 2 * kFloat32Displacement);  // two ticks
  EXPECT_LT(relativeError(end.velocity_m_per_s, reference.v_m_per_s, reference.active), 2 * kFloat32Velocity);
}

TEST_P(Moments, TheirEnergyIsMeasured) {
  for (const Body& body : {ball(), block({4, 4, 6})}) {
    const Model model = modelOf({body});
    const auto solver = make(model, sceneFor(model, 1));
    const HostState start = randomState(model, 0.1 * kSpacing_m, 0, 3);
    solver->writeState(start);
    ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()));
    load(reference, start);
    solver->step({});
    reference.substep();
    const double truth_j = reference.elasticEnergy();
    layout::TickStats stats{};
    ASSERT_TRUE(solver->pollStats(stats, true));
    EXPECT_NEAR(static_cast<double>(stats.elastic_j), truth_j, kFloat32Energy * truth_j);
  }
}
