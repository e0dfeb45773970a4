// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cells of the neo-Hookean law on the backends, against the float64 reference.
#include "layout/law.h"

#include <algorithm>
#include <array>
#include <random>

#include "math/float_bits.h"
#include "support/random_state.h"
#include "support/solver_rig.h"
#include "viscera/model/body/elasticity.h"

using namespace viscera;
using namespace viscera::test;

namespace {

// Relative to the largest value: float32 rounds at 6e-8, and a cell's forces are sums of some hundred products.
constexpr double kLawFloat32Displacement = 2e-6;
constexpr double kLawFloat32Velocity = 1e-5;
constexpr double kLawFloat32Energy = 2e-5;
constexpr double kLawSpacing_m = 0.01;

/// Returns a ball not aligned with the lattice: full cells inside, all kinds of partial ones around.
Body lawBall(double nu = 0.3) {
  return ofLaw(momentBody({8, 8, 8}, kLawSpacing_m,
                          [](const Vector3d& p) { return (p - Vector3d(4.1, 3.8, 4.3)).norm() < 3.3; }),
               nu);
}

Body lawBlock(const Vector3i& cells, double nu = 0.3) {
  return ofLaw(boxBody(cells, kLawSpacing_m), nu);
}

/// Gives each cell of a layer 30 % of one part below and 70 % of another above.
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

/// Returns the body with a stress at rest in each cell that is not balanced and varies between cells.
Body stressed(Body body) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> stress(-0.3f, 0.6f);  // over mu, as from strains of a third
  body.prestress.resize(body.lattice.nodes.size());
  for (std::array<float, 6>& cell : body.prestress)
    std::generate(cell.begin(), cell.end(), [&] { return stress(random); });
  return body;
}

class NeoHookean : public OnBackend {
 protected:
  void expectLikeReference(const Model& model, double size_m, int substeps) {
    const Vector3d gravity(0.3, -0.2, -9.81);
    const auto solver = make(model, sceneFor(model, substeps, {}, gravity));
    ReferenceSolver reference(model, gravity, static_cast<float>(solver->dt_s()));
    ASSERT_EQ(solver->substeps(), substeps);
    expectSameTick(*solver, reference, randomState(model, size_m, 0.1, 7), kLawFloat32Displacement,
                   kLawFloat32Velocity);
  }
  void expectCutLikeReference(const Body& body);
  void expectLikeReference(const Body& body, double size_m = 0.05 * kLawSpacing_m, int substeps = 10) {
    expectLikeReference(modelOf({body}), size_m, substeps);
  }
};

INSTANTIATE_TEST_SUITE_P(Backends, NeoHookean, ::testing::ValuesIn(backendNames()), backendSuffix);

}  // namespace

TEST_P(NeoHookean, FullCellsMatchTheReferenceForAnyPoissonRatio) {
  for (const double nu : {0.0, 0.25, 0.45, 0.49}) {
    SCOPED_TRACE(nu);
    expectLikeReference(lawBlock({5, 6, 9}, nu));
  }
}

TEST_P(NeoHookean, PartialCellsMatchTheReferenceForAnyPoissonRatio) {
  for (const double nu : {0.0, 0.25, 0.45, 0.49}) {
    SCOPED_TRACE(nu);
    expectLikeReference(lawBall(nu));
  }
}

/// Up to inverted cells.
TEST_P(NeoHookean, LargeStrainsMatchTheReference) {
  for (const double size : {0.2, 0.5, 0.9}) {
    SCOPED_TRACE(size);
    expectLikeReference(lawBall(), size * kLawSpacing_m, 1);
    expectLikeReference(lawBlock({4, 5, 6}), size * kLawSpacing_m, 1);
  }
}

/// Compressed along an axis, and mirrored; full cells and partial ones.
TEST_P(NeoHookean, CrushedCellsMatchTheReference) {
  for (const Body& body : {lawBlock({4, 4, 4}), lawBall()}) {
    const Model model = modelOf({body});
    const Lattice& lattice = model.bodies[0].lattice;
    for (const bool mirrored : {false, true}) {
      SCOPED_TRACE(::testing::Message() << body.lattice.fills.size() << (mirrored ? ", mirrored" : ", squeezed"));
      HostState start = randomState(model, 0.02 * kLawSpacing_m, 0.1, 5);
      for (const uint32_t slot : lattice.active_slots) {
        const Vector3d x = lattice.restPosition(slot);
        layout::vec4& u = start.displacement_m[slot];
        if (mirrored)
          u.x -= static_cast<float>(2 * x.x());
        else
          u.z -= static_cast<float>(0.7 * x.z());
      }
      const auto solver = make(model, sceneFor(model, 1));
      ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()));
      expectSameTick(*solver, reference, start, kLawFloat32Displacement, kLawFloat32Velocity);
    }
  }
}

/// From strains at which it hardly matters to those beyond kMostExponent.
TEST_P(NeoHookean, StiffeningMatchesTheReference) {
  for (const double size : {0.05, 0.2, 0.5}) {
    SCOPED_TRACE(size);
    for (Body body : {lawBall(), lawBlock({4, 5, 6})}) {
      body.material.stiffening = 4;
      expectLikeReference(body, size * kLawSpacing_m, 1);
    }
  }
}

TEST_P(NeoHookean, PartsMatchTheReference) {
  Body body = lawBall();
  body.lattice.part_names = {"wall", "valve"};
  for (uint32_t slot = 0; slot < body.lattice.nodes.size(); ++slot) {
    uint16_t& label = body.lattice.cell_labels[slot];
    if (label && body.lattice.nodeAt(slot).x() >= 4) label = 2;
  }
  body.parts = {{"valve", 100e3, 0.4, 3000}};
  expectLikeReference(body);
  expectLikeReference(body, 0.5 * kLawSpacing_m, 1);
}

TEST_P(NeoHookean, CellsThatPartsShareMatchTheReference) {
  for (Body body : {lawBall(), lawBlock({5, 4, 9})}) {
    shareLayer(body);
    expectLikeReference(body);
  }
}

/// The kernels take three Newton steps for the jump between the layers, the reference as many as it needs.
TEST_P(NeoHookean, LayersAtLargeStrainsMatchTheReference) {
  // After one substep: the remaining error of the jump after three steps is largest where cells are nearly flat.
  constexpr double kJumpLeft = 1e-4;
  const Vector3d gravity(0.3, -0.2, -9.81);
  Body body = lawBall();
  shareLayer(body);
  const Model model = modelOf({body});
  for (const double size : {0.1, 0.3}) {
    SCOPED_TRACE(size);
    const auto solver = make(model, sceneFor(model, 1, {}, gravity));
    ReferenceSolver reference(model, gravity, static_cast<float>(solver->dt_s()));
    expectSameTick(*solver, reference, randomState(model, size * kLawSpacing_m, 0.1, 7), kJumpLeft,
                   kJumpLeft / kLawFloat32Displacement * kLawFloat32Velocity);
  }
}

TEST_P(NeoHookean, BodiesOfBothLawsMatchTheReference) {
  const Body springs = boxBody({3, 4, 3}, kLawSpacing_m);
  expectLikeReference(modelOf({springs, lawBall(), lawBlock({2, 3, 2})}), 0.05 * kLawSpacing_m, 10);
}

TEST_P(NeoHookean, DampingMatchesTheReference) {
  Body body = lawBall();
  body.material.stiffness_damping_ratio = 0.2;
  expectLikeReference(body);
  expectLikeReference(body, 0.3 * kLawSpacing_m, 1);
}

TEST_P(NeoHookean, StressAtRestMatchesTheReference) {
  for (const Body& body : {stressed(lawBlock({5, 6, 9})), stressed(lawBall(0.45))}) {
    expectLikeReference(body);
    expectLikeReference(body, 0.5 * kLawSpacing_m, 1);
    expectLikeReference(body, 0.9 * kLawSpacing_m, 1);
  }
}

/// Compares a cut with the reference: the blade sweeps half way through the ball.
void NeoHookean::expectCutLikeReference(const Body& body) {
  constexpr int kSubsteps = 10;
  Body ball = body;
  ball.material.stiffness_damping_ratio = 0.2;
  const Model model = modelOf({ball});
  std::vector<StylusConfig> styluses(2);
  styluses[0].cut.blade_length_m = 0.2;
  styluses[0].cut.blade_side = BladeSide::kAhead;
  const auto solver = make(model, sceneFor(model, kSubsteps, styluses));
  const HostState start = randomState(model, 0.02 * kLawSpacing_m, 0.05, 7);
  solver->writeState(start);
  ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()));
  load(reference, start);
  // The blade points down and sweeps half way through the ball.
  tickBoth(*solver, reference, styluses, kSubsteps, tool(ToolMode::kCut, {-0.02, 0.0452, 0.16}, {0.043, 0.0452, 0.16}));
  tickBoth(*solver, reference, styluses, kSubsteps, {});
  size_t broken = 0;
  const HostState end = solver->readState();
  for (const uint32_t slot : reference.active)
    broken += end.nodes[slot].lo & layout::kLawCellBit && !(end.nodes[slot].lo & layout::kCellBit) ? 1 : 0;
  EXPECT_GT(broken, 20u);
  expectSameState(end, reference, 2 * kLawFloat32Displacement, 2 * kLawFloat32Velocity);  // two ticks
  layout::TickStats stats{};
  while (solver->pollStats(stats, true)) {
  }
  const double truth_j = reference.elasticEnergy();
  EXPECT_NEAR(static_cast<double>(stats.elastic_j), truth_j, kLawFloat32Energy * std::abs(truth_j));
}

TEST_P(NeoHookean, CellsThatABladeCutsMatchTheReference) {
  expectCutLikeReference(lawBall());
}

TEST_P(NeoHookean, StressAtRestGoesOverToWhatACutLeaves) {
  expectCutLikeReference(stressed(lawBall()));
}

TEST_P(NeoHookean, TheirEnergyAndStiffeningAreMeasured) {
  for (const double size : {0.05, 0.2}) {
    Body stiffening = lawBall();
    stiffening.material.stiffening = 4;
    Body layers = lawBall();
    shareLayer(layers);
    for (const Body& body : {lawBall(), lawBlock({4, 4, 6}), lawBlock({4, 4, 6}, 0.49), stiffening, stressed(lawBall()),
                             layers, stressed(layers)}) {
      const Model model = modelOf({body});
      const auto solver = make(model, sceneFor(model, 1));
      const HostState start = randomState(model, size * kLawSpacing_m, 0, 3);
      solver->writeState(start);
      ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()));
      load(reference, start);
      solver->step({});
      reference.substep();
      const double truth_j = reference.elasticEnergy();
      layout::TickStats stats{};
      ASSERT_TRUE(solver->pollStats(stats, true));
      EXPECT_NEAR(static_cast<double>(stats.elastic_j), truth_j, kLawFloat32Energy * std::abs(truth_j));
      EXPECT_GT(floatFromBits(stats.max_stiffening_bits), 1.0f + static_cast<float>(size));
      EXPECT_LT(floatFromBits(stats.max_stiffening_bits), 20.0f * (1 + static_cast<float>(body.material.stiffening)));
    }
  }
}

/// Compressed to one half along an axis, sides fixed: waves along it have the modulus 1/2 (1 + 1/J^2) of W'' and the
/// isochoric part, by hand for nu = 0.3: K/mu = 13/6.
TEST_P(NeoHookean, StiffeningIsThatOfPlaneWaves) {
  const Model model = modelOf({lawBlock({4, 4, 4})});
  const auto solver = make(model, sceneFor(model, 1));
  HostState start = restState(model);
  const Lattice& lattice = model.bodies[0].lattice;
  constexpr double kSqueezed = 0.5;
  for (const uint32_t slot : lattice.active_slots)
    start.displacement_m[slot].x = static_cast<float>((kSqueezed - 1) * kLawSpacing_m * lattice.nodeAt(slot).x());
  solver->writeState(start);
  const double l = kSqueezed, phi = std::pow(l, -2.0 / 3), size = l * l + 2;
  // d2W/dl2 for F = diag(l, 1, 1), over mu; at rest lambda/mu + 2 = 7/2.
  const double waves = phi - 4.0 / 3 * phi + 5.0 / 9 * phi * size / (l * l) + 13.0 / 12 * (1 + 1 / (l * l));
  solver->step({});
  layout::TickStats stats{};
  ASSERT_TRUE(solver->pollStats(stats, true));
  constexpr double kMovesInASubstep = 0.02;  // it springs back within the tick
  EXPECT_NEAR(static_cast<double>(floatFromBits(stats.max_stiffening_bits)), waves / 3.5, kMovesInASubstep * waves);
}

TEST_P(NeoHookean, NothingIsLeftOfForcesBeforeAStateWithCuts) {
  const Model model = modelOf({lawBlock({7, 3, 3})});
  const Lattice& lattice = model.bodies[0].lattice;
  const Scene scene = sceneFor(model, 10);
  const HostState whole = randomState(model, 0.05 * kLawSpacing_m, 0.1, 3);
  // Nodes at x = 4 begin a brick, and keep only the springs to the nodes before them.
  HostState cut = randomState(model, 0.05 * kLawSpacing_m, 0.1, 4);
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
  used->writeState(cut);
  used->step({});
  fresh->writeState(cut);
  fresh->step({});
  EXPECT_EQ(stateHash(model, used->readState()), stateHash(model, fresh->readState()));
  used->writeState(whole);
  used->step({});
  const auto never_cut = make(model, scene);
  never_cut->writeState(whole);
  never_cut->step({});
  EXPECT_EQ(stateHash(model, used->readState()), stateHash(model, never_cut->readState()));
}
