// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cells by moments on the backends, against the float64 reference.
#include "support/random_state.h"
#include "support/solver_rig.h"
#include "viscera/model/body/elasticity.h"

using namespace viscera;
using namespace viscera::test;

namespace {

// Relative to the largest value: float32 rounds at 6e-8; a cell's forces are sums of some forty products on the way.
constexpr double kMomentsFloat32Displacement = 2e-6;
constexpr double kMomentsFloat32Velocity = 1e-5;
constexpr double kFloat32Energy = 2e-5;
constexpr double kMomentsSpacing_m = 0.01;

/// A ball off the lattice: full cells inside, all kinds of partial ones around.
Body ball() {
  return momentBody({8, 8, 8}, kMomentsSpacing_m,
                    [](const Vector3d& p) { return (p - Vector3d(4.1, 3.8, 4.3)).norm() < 3.3; });
}

Body block(const Vector3i& cells) {
  Body body = boxBody(cells, kMomentsSpacing_m);
  body.material.cells = Cells::kMoments;
  return body;
}

/// Each cell of a layer has 30 % of one part below and 70 % of another above.
void shareLayer(Body& body) {
  Lattice& lattice = body.lattice;
  lattice.part_names = {"wall", "valve"};
  body.parts = {{"valve", 100e3, 0.4, 3000}};
  constexpr double kLow = 0.3;
  const auto slab = [](double share, double middle) {
    const Vector3d spread(1.0 / 12, 1.0 / 12, share * share / 12 + middle * middle);
    return CellFill{share, {0, 0, share * middle}, share * Eigen::Matrix3d(spread.asDiagonal())};
  };
  for (uint32_t slot = 0; slot < lattice.nodes.size(); ++slot) {
    if (!lattice.cell_labels[slot] || lattice.nodeAt(slot).z() < 3) continue;
    lattice.cell_labels[slot] = 2;
    if (lattice.nodeAt(slot).z() > 3) continue;
    lattice.shared.push_back({slot, 1, slab(kLow, 0.5 * kLow - 0.5)});
    lattice.shared.push_back({slot, 2, slab(1 - kLow, 0.5 * kLow)});
  }
}

class Moments : public OnBackend {
 protected:
  void expectLikeReference(const Model& model, const Scene& scene, double size_m, int substeps) {
    const auto solver = make(model, scene);
    ReferenceSolver reference(model, Vector3d(0.3, -0.2, -9.81), static_cast<float>(solver->dt_s()));
    ASSERT_EQ(solver->substeps(), substeps);
    expectSameTick(*solver, reference, randomState(model, size_m, 0.1, 7), kMomentsFloat32Displacement,
                   kMomentsFloat32Velocity);
  }
  void expectLikeReference(const Body& body, double size_m = 0.05 * kMomentsSpacing_m, int substeps = 10) {
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

TEST_P(Moments, ThinWallsMatchTheReferenceForAnyPoissonRatio) {
  for (const double nu : {0.0, 0.25, 0.45, 0.49}) {
    SCOPED_TRACE(nu);
    for (const double thickness_cells : {0.8, 1.5, 2.4}) {
      Body body = thinBody(thickness_cells, kMomentsSpacing_m);
      body.material.poisson_ratio = nu;
      ASSERT_GT(cellMoments(body).bends.size(), 20u);
      expectLikeReference(body);
    }
  }
}

TEST_P(Moments, ThinWallsOfPartsStrainedOrTornMatchTheReference) {
  Body body = thinBody(1.2, kMomentsSpacing_m);
  body.material.dashpot_ratio = 0.2;
  for (const double size : {0.2, 0.5}) expectLikeReference(body, size * kMomentsSpacing_m, 1);
  body.lattice.part_names = {"wall", "valve"};
  bool torn = false;
  for (const CellBend& bend : cellMoments(body).bends) {
    if (body.lattice.nodeAt(bend.cell).x() >= 4) body.lattice.cell_labels[bend.cell] = 2;
    if (!torn) body.lattice.nodes[bend.cell].lo &= ~layout::kCellBit;
    torn = true;
  }
  body.parts = {{"valve", 100e3, 0.4, 3000}};
  expectLikeReference(body);
}

TEST_P(Moments, WallsThatAreThickForTheirCellsAreAsTheyWere) {
  Body body = ball();
  body.material.thin_walls = true;
  EXPECT_TRUE(cellMoments(body).bends.empty());
  expectLikeReference(body);
}

TEST_P(Moments, StrainsThatFadeThemOutMatchTheReference) {
  for (const double size : {0.2, 0.5}) {
    SCOPED_TRACE(size);
    expectLikeReference(ball(), size * kMomentsSpacing_m, 1);
    expectLikeReference(block({4, 5, 6}), size * kMomentsSpacing_m, 1);
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

TEST_P(Moments, CellsThatPartsShareMatchTheReference) {
  for (Body body : {ball(), block({5, 4, 9})}) {
    shareLayer(body);
    expectLikeReference(body);
  }
}

TEST_P(Moments, BodiesOfBothKindsMatchTheReference) {
  Body springs = boxBody({3, 4, 3}, kMomentsSpacing_m);
  springs.material.poisson_ratio = 0.4;
  const Model model = modelOf({springs, ball(), block({2, 3, 2})});
  expectLikeReference(model, sceneFor(model, 10, {}, Vector3d(0.3, -0.2, -9.81)), 0.05 * kMomentsSpacing_m, 10);
}

TEST_P(Moments, DashpotsAndSpringsOfAnyLengthMatchTheReference) {
  Body body = ball();
  body.material.dashpot_ratio = 0.2;
  expectLikeReference(body);
  expectLikeReference(body, 0.3 * kMomentsSpacing_m, 1);
}

TEST_P(Moments, CellsThatABladeCutsMatchTheReference) {
  constexpr int kSubsteps = 10;
  const Model model = modelOf({ball()});
  std::vector<StylusConfig> styluses(2);
  styluses[0].cut.blade_length_m = 0.2;
  styluses[0].cut.blade_side = BladeSide::kAhead;
  const auto solver = make(model, sceneFor(model, kSubsteps, styluses));
  const HostState start = randomState(model, 0.02 * kMomentsSpacing_m, 0.05, 7);
  solver->writeState(start);
  ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()));
  load(reference, start);
  // The blade points down and sweeps half way through the ball.
  tickBoth(*solver, reference, styluses, kSubsteps, tool(ToolMode::kCut, {-0.02, 0.0452, 0.16}, {0.043, 0.0452, 0.16}));
  tickBoth(*solver, reference, styluses, kSubsteps, {});
  size_t cut = 0;
  const HostState end = solver->readState();
  for (const uint32_t slot : reference.active) {
    const layout::NodeBits &before = start.nodes[slot], &now = end.nodes[slot];
    cut += before.lo != now.lo || before.hi != now.hi ? 1 : 0;
  }
  EXPECT_GT(cut, 50u);
  expectSameState(end, reference, 2 * kMomentsFloat32Displacement, 2 * kMomentsFloat32Velocity);  // two ticks
}

TEST_P(Moments, TheirEnergyIsMeasured) {
  for (const Body& body : {ball(), block({4, 4, 6}), thinBody(1.2, kMomentsSpacing_m)}) {
    const Model model = modelOf({body});
    const auto solver = make(model, sceneFor(model, 1));
    const HostState start = randomState(model, 0.1 * kMomentsSpacing_m, 0, 3);
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

TEST_P(Moments, NothingIsLeftOfForcesBeforeAStateWithCuts) {
  const Model model = modelOf({block({7, 3, 3})});
  const Lattice& lattice = model.bodies[0].lattice;
  const Scene scene = sceneFor(model, 10);
  const HostState whole = randomState(model, 0.05 * kMomentsSpacing_m, 0.1, 3);
  // Nodes at x = 4 begin a brick, and keep the springs to the one before them only.
  HostState cut = randomState(model, 0.05 * kMomentsSpacing_m, 0.1, 4);
  for (const uint32_t slot : lattice.active_slots) {
    const int x = lattice.nodeAt(slot).x();
    layout::NodeBits& bits = cut.nodes[slot];
    if (x >= 3) bits.lo = (bits.lo | layout::kSeveredBit) & ~layout::kCellBit;
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      if (std::min(x, x + kNeighborOffsets[s][0]) >= 4) setSpringCount(bits, s, 0);
    }
  }
  const auto used = make(model, scene), fresh = make(model, scene);
  used->writeState(whole);
  used->step({});
  for (const auto& solver : {used.get(), fresh.get()}) {
    solver->writeState(cut);
    solver->step({});
  }
  EXPECT_EQ(stateHash(model, used->readState()), stateHash(model, fresh->readState()));
}
