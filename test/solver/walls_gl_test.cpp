// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cells in thin walls, with second derivatives from rows of nodes, against the float64 reference.
#include <algorithm>

#include "math/float_bits.h"
#include "solver/cpu/cpu_solver.h"
#include "support/random_state.h"
#include "support/sleeping.h"
#include "support/solver_rig.h"
#include "viscera/model/body/wall_cells.h"

using namespace viscera;
using namespace viscera::test;

namespace {

// Relative to the largest value, as for cells of the law (law_gl_test.cpp).
constexpr double kWallFloat32Displacement = 2e-6;
constexpr double kWallFloat32Velocity = 1e-5;
constexpr double kWallFloat32Energy = 2e-5;
constexpr double kWallSpacing_m = 0.01;
constexpr double kWallThickness = 0.75;  // in cells

Body byRows(Body body) {
  body.material.walls = Walls::kRows;
  return body;
}

/// Returns a plate that is oblique to all axes.
Body askewPlate(double nu = 0.3, const Vector3i& cells = {9, 8, 7}, double spacing_m = kWallSpacing_m) {
  const Vector3d normal = Vector3d(0.5, 0.3, 1).normalized(), middle = 0.5 * cells.cast<double>();
  return byRows(
      ofLaw(momentBody(cells, spacing_m,
                       [&](const Vector3d& p) { return std::abs((p - middle).dot(normal)) < 0.5 * kWallThickness; }),
            nu));
}

/// Returns a bowl that is open above.
Body thinBowl(double nu = 0.3) {
  const auto inside = [](const Vector3d& p) {
    const Vector3d from_middle = p - Vector3d(5.1, 4.9, 5.2);
    return std::abs(from_middle.norm() - 4) < 0.5 * kWallThickness && from_middle.z() < 1;
  };
  return byRows(ofLaw(momentBody({10, 10, 8}, kWallSpacing_m, inside), nu));
}

/// Divides each cell into two materials by a plane through its centroid.
void makeWallLayers(Body& body) {
  Lattice& lattice = body.lattice;
  lattice.part_names = {"wall", "coat"};
  body.parts = {{"coat", 100e3, 0.4, 3000}};
  for (uint32_t slot = 0; slot < lattice.nodes.size(); ++slot) {
    if (!lattice.cell_labels[slot]) continue;
    const CellFill all = fillOf(lattice, slot);
    CellFill below = all, above = all;
    for (CellFill* half : {&below, &above}) {
      const Vector3d off(0, 0, half == &below ? -0.1 : 0.1), centroid = all.first / all.share;
      half->share = 0.5 * all.share;
      half->first = half->share * (centroid + off);
      half->second = 0.5 * all.second + half->share * (off * centroid.transpose() + centroid * off.transpose());
    }
    lattice.shared.push_back({slot, 1, below});
    lattice.shared.push_back({slot, 2, above});
  }
}

class ThinWalls : public OnBackend {
 protected:
  void expectLikeReference(const Model& model, double size, int substeps, double error = kWallFloat32Displacement) {
    ASSERT_FALSE(wallCells(model.bodies.back()).empty());
    const Vector3d gravity(0.3, -0.2, -9.81);
    const auto solver = make(model, sceneFor(model, substeps, {}, gravity));
    ReferenceSolver reference(model, gravity, static_cast<float>(solver->dt_s()));
    ASSERT_EQ(solver->substeps(), substeps);
    expectSameTick(*solver, reference, randomState(model, size * kWallSpacing_m, 0.1, 7), error,
                   error / kWallFloat32Displacement * kWallFloat32Velocity);
  }
  void expectLikeReference(const Body& body, double size, int substeps = 1) {
    expectLikeReference(modelOf({body}), size, substeps);
  }
};

INSTANTIATE_TEST_SUITE_P(Backends, ThinWalls, ::testing::ValuesIn(backendNames()), backendSuffix);

}  // namespace

TEST_P(ThinWalls, AskewPlatesMatchTheReferenceForAnyPoissonRatio) {
  for (const double nu : {0.0, 0.25, 0.45, 0.49}) {
    SCOPED_TRACE(nu);
    expectLikeReference(askewPlate(nu), 0.02, 10);
    expectLikeReference(askewPlate(nu), 0.2);
  }
}

TEST_P(ThinWalls, BowlsMatchTheReference) {
  expectLikeReference(thinBowl(), 0.02, 10);
  expectLikeReference(thinBowl(), 0.2);
}

/// Includes inverted cells.
TEST_P(ThinWalls, LargeStrainsMatchTheReference) {
  for (const double size : {0.5, 0.9}) {
    SCOPED_TRACE(size);
    expectLikeReference(askewPlate(), size);
  }
}

TEST_P(ThinWalls, DampingMatchesTheReference) {
  Body body = askewPlate();
  body.material.stiffness_damping_ratio = 0.2;
  expectLikeReference(body, 0.02, 10);
  expectLikeReference(body, 0.2);
}

TEST_P(ThinWalls, StiffeningMatchesTheReference) {
  Body body = askewPlate();
  body.material.stiffening = 4;
  for (const double size : {0.05, 0.1}) expectLikeReference(body, size);
}

TEST_P(ThinWalls, LayersMatchTheReference) {
  constexpr double kJumpLeft = 1e-4;  // of three steps of Newton's method, as in law_gl_test.cpp
  Body body = askewPlate();
  makeWallLayers(body);
  expectLikeReference(modelOf({body}), 0.02, 1);
  expectLikeReference(modelOf({body}), 0.2, 1, kJumpLeft);
}

TEST_P(ThinWalls, AmongOtherBodiesMatchTheReference) {
  const Body springs = boxBody({3, 4, 3}, kWallSpacing_m), full = ofLaw(boxBody({2, 3, 2}, kWallSpacing_m));
  expectLikeReference(modelOf({springs, full, askewPlate()}), 0.05, 10);
}

TEST_P(ThinWalls, TheirEnergyAndStiffeningAreMeasured) {
  for (const double size : {0.02, 0.2}) {
    for (const double stiffness_damping_ratio : {0.0, 0.2}) {
      Body body = thinBowl();
      body.material.stiffness_damping_ratio = stiffness_damping_ratio;
      const Model model = modelOf({body});
      const auto solver = make(model, sceneFor(model, 1));
      const HostState start = randomState(model, size * kWallSpacing_m, 0, 3);
      solver->writeState(start);
      ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()));
      load(reference, start);
      solver->step({});
      reference.substep();
      const double truth_j = reference.elasticEnergy();
      layout::TickStats stats{};
      ASSERT_TRUE(solver->pollStats(stats, true));
      EXPECT_NEAR(static_cast<double>(stats.elastic_j), truth_j, kWallFloat32Energy * std::abs(truth_j));
      EXPECT_GT(floatFromBits(stats.max_stiffening_bits), 1.0f + static_cast<float>(size));
    }
  }
}

/// A blade that points down sweeps half of the distance through a bowl: cells lose springs, and rows of intact ones end
/// there.
TEST_P(ThinWalls, RowsThatABladeCutsMatchTheReference) {
  constexpr int kSubsteps = 10;
  Body body = thinBowl();
  body.material.stiffness_damping_ratio = 0.2;
  const Model model = modelOf({body});
  std::vector<StylusConfig> styluses(2);
  styluses[0].cut.blade_length_m = 0.2;
  styluses[0].cut.blade_side = BladeSide::kAhead;
  const auto solver = make(model, sceneFor(model, kSubsteps, styluses));
  const HostState start = randomState(model, 0.02 * kWallSpacing_m, 0.05, 7);
  solver->writeState(start);
  ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()));
  load(reference, start);
  tickBoth(*solver, reference, styluses, kSubsteps, tool(ToolMode::kCut, {-0.02, 0.0452, 0.16}, {0.063, 0.0452, 0.16}));
  tickBoth(*solver, reference, styluses, kSubsteps, {});
  size_t broken = 0;
  const HostState end = solver->readState();
  for (const WallCell& wall : wallCells(body)) broken += end.nodes[wall.cell].lo & layout::kCellBit ? 0 : 1;
  EXPECT_GT(broken, 5u);
  expectSameState(end, reference, 2 * kWallFloat32Displacement, 2 * kWallFloat32Velocity);  // two ticks
  const double truth_j = reference.elasticEnergy();
  EXPECT_NEAR(static_cast<double>(lastStats(*solver).elastic_j), truth_j, kWallFloat32Energy * std::abs(truth_j));
}

namespace {

/// Returns an oblique plate that is fixed at one end, with ghosts beyond.
Body clampedPlate(double nu = 0.3) {
  Body body = askewPlate(nu);
  for (const uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).x() == 0) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  addRowGhosts(body);
  return body;
}

/// Returns a random state in which ghosts are displaced and move, too, and fixed nodes are displaced.
HostState randomWithGhosts(const Model& model, double size_m, double speed_m_per_s, uint32_t seed) {
  std::mt19937 random(seed);
  HostState state = randomState(model, size_m, speed_m_per_s, seed);
  for (const uint32_t slot : model.bodies[0].lattice.active_slots) {
    if (isFixed(model.bodies[0].lattice.nodes[slot])) state.velocity_m_per_s[slot] = {0, 0, 0, 0};
  }
  for (const RowGhost& ghost : model.bodies[0].lattice.ghosts) {
    state.displacement_m[ghost.slot] = vec4(randomVector(random, size_m));
    state.velocity_m_per_s[ghost.slot] = vec4(randomVector(random, speed_m_per_s));
  }
  return state;
}

}  // namespace

/// Ghosts lie beyond fixed corners of cells in walls, in new bricks. They have neither springs nor mass.
TEST(RowGhosts, ContinueTheRowsOfAClamp) {
  const Body without = askewPlate(), body = clampedPlate();
  const Lattice& lattice = body.lattice;
  ASSERT_GT(lattice.ghosts.size(), 5u);
  EXPECT_EQ(lattice.active_slots, without.lattice.active_slots);
  EXPECT_GT(lattice.bricks.size(), without.lattice.bricks.size());
  EXPECT_DOUBLE_EQ(massOf_kg(body), massOf_kg(without));
  for (const RowGhost& ghost : lattice.ghosts) {
    EXPECT_EQ(lattice.nodeAt(ghost.slot), lattice.nodeAt(ghost.fixed) - Vector3i::UnitX());
    EXPECT_TRUE(isGhost(lattice.nodes[ghost.slot]));
    EXPECT_TRUE(isWithinRow(lattice.nodes[ghost.fixed], 0));
    EXPECT_LT(lattice.slotAt(lattice.nodeAt(ghost.slot)), 0);
  }
}

TEST(RowGhosts, NeedAFixedCornerOfAThinWall) {
  Body free = askewPlate(), of_cells = clampedPlate();
  addRowGhosts(free);
  EXPECT_TRUE(free.lattice.ghosts.empty());
  of_cells = askewPlate();
  of_cells.material.walls = Walls::kCells;
  for (const uint32_t slot : of_cells.lattice.active_slots) of_cells.lattice.nodes[slot].lo |= layout::kFixedBit;
  addRowGhosts(of_cells);
  EXPECT_TRUE(of_cells.lattice.ghosts.empty());
}

TEST_P(ThinWalls, ClampedOnesWithGhostsMatchTheReference) {
  for (const double stiffness_damping_ratio : {0.0, 0.2}) {
    Body body = clampedPlate();
    body.material.stiffness_damping_ratio = stiffness_damping_ratio;
    body.material.mass_damping_per_s = 3;
    const Model model = modelOf({body});
    const Vector3d gravity(0.3, -0.2, -9.81);
    for (const auto& [size, substeps] : {std::pair{0.02, 10}, std::pair{0.2, 1}}) {
      const auto solver = make(model, sceneFor(model, substeps, {}, gravity));
      ReferenceSolver reference(model, gravity, static_cast<float>(solver->dt_s()));
      const HostState start = randomWithGhosts(model, size * kWallSpacing_m, 0.1, 7);
      const HostState end = expectSameTick(*solver, reference, start, kWallFloat32Displacement, kWallFloat32Velocity);
      const uint32_t ghost = body.lattice.ghosts.front().slot;
      EXPECT_NE(xyz(end.displacement_m[ghost]), xyz(start.displacement_m[ghost]));
    }
  }
}

/// Where a blade cuts the spring between a fixed node and the tissue, the ghost stops.
TEST_P(ThinWalls, GhostsBehindACutStop) {
  constexpr int kSubsteps = 10;
  const Model model = modelOf({clampedPlate()});
  const Lattice& lattice = model.bodies[0].lattice;
  std::vector<StylusConfig> styluses(2);
  styluses[0].cut.blade_length_m = 0.2;
  styluses[0].cut.blade_side = BladeSide::kAhead;
  const auto solver = make(model, sceneFor(model, kSubsteps, styluses));
  solver->writeState(randomWithGhosts(model, 0.02 * kWallSpacing_m, 0.05, 7));
  solver->step(tool(ToolMode::kCut, {0.0045, -0.02, 0.16}, {0.0045, 0.1, 0.16}));
  const HostState cut = solver->readState();
  solver->step({});
  const HostState end = solver->readState();
  size_t stopped = 0;
  for (const RowGhost& ghost : lattice.ghosts) {
    const bool whole = isWithinRow(cut.nodes[ghost.fixed], static_cast<int>(ghost.spring / 2));
    const bool same = xyz(end.displacement_m[ghost.slot]) == xyz(cut.displacement_m[ghost.slot]);
    EXPECT_EQ(same, !whole);
    stopped += same ? 1 : 0;
  }
  EXPECT_GT(stopped, 5u);
}

/// A ghost has no weight: gravity does not move it while the nodes around it are fixed.
TEST_P(ThinWalls, GhostsHaveNoWeight) {
  Body body = clampedPlate();
  for (const uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).x() <= 4) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  const Model model = modelOf({body});
  const auto solver = make(model, sceneFor(model, 5, {}, {0, 0, -9.81}));
  solver->step({});
  const HostState end = solver->readState();
  for (const RowGhost& ghost : body.lattice.ghosts) EXPECT_LT(xyz(end.displacement_m[ghost.slot]).norm(), 1e-9);
}

namespace {

/// Returns a plate of several bricks, held at one end.
Body sleepyPlate() {
  Body body = askewPlate(0.3, {23, 8, 15}, kSleepSpacing_m);
  body.material.mass_damping_per_s = kSleepDrag_per_s;
  body.material.stiffness_damping_ratio = 0.2;
  for (const uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).x() == 0) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  return body;
}

/// Returns a probe at rest in the free end.
ToolMotions probeAtEnd(const Model& model) {
  const Lattice& lattice = model.bodies[0].lattice;
  const auto farther = [&](uint32_t a, uint32_t b) { return lattice.nodeAt(a).sum() < lattice.nodeAt(b).sum(); };
  const uint32_t end = *std::max_element(lattice.active_slots.begin(), lattice.active_slots.end(), farther);
  return probeAt(lattice.restPosition(end) + Vector3d(0.003, 0, 0.003));
}

/// Expects sleeping bricks next to bricks that a probe has woken to miss nothing: forces of cells and rows there are up
/// to date.
template <class Sleeper>
void expectToMoveAsWithoutSleep() {
  const Model model = modelOf({sleepyPlate()});
  ASSERT_FALSE(wallCells(model.bodies[0]).empty());
  // Motion that sleeping bricks skip is slower than the sleep speed, and the drag of 60 1/s stops it within 1/60 s.
  const double left_out_m = kSleepSpeed_m_per_s / kSleepDrag_per_s;
  Sleeper sleeper(model, sleepyScene(model)), watcher(model, sleepyScene(model, {0}));
  ASSERT_LT(settle(sleeper), 50);
  size_t slept = 0;
  double farthest_m = 0, offset_m = 0;
  for (int t = 0; t < 30; ++t) {
    sleeper.step(probeAtEnd(model));
    watcher.step(probeAtEnd(model));
    slept += sleeper.bricks() - sleeper.awakeBricks();
    farthest_m = std::max(farthest_m, farthestApart_m(model, sleeper.readState(), watcher.readState()));
    offset_m = std::max(offset_m, farthestApart_m(model, sleeper.readState(), restState(model)));
  }
  EXPECT_GT(slept, 0u);
  EXPECT_GT(offset_m, 1e-3);
  EXPECT_LT(farthest_m, left_out_m);
}

/// Expects lists of cells to change no bit if all bricks are awake.
template <class Sleeper>
void expectToMoveAsWithoutSleepToTheBit() {
  const Model model = modelOf({sleepyPlate()});
  Sleeper sleeper(model, sleepyScene(model)), watcher(model, sleepyScene(model, {0}));
  const HostState start = randomState(model, 0.05 * kSleepSpacing_m, 0.1, 3);
  for (Sleeper* solver : {&sleeper, &watcher}) {
    solver->writeState(start);
    for (int t = 0; t < 3; ++t) solver->step(ToolMotions{});
  }
  EXPECT_EQ(sleeper.awakeBricks(), sleeper.bricks());
  EXPECT_EQ(stateHash(model, sleeper.readState()), stateHash(model, watcher.readState()));
}

}  // namespace

TEST_P(ThinWalls, MoveAsWithoutSleep) {
  GetParam() == "gpu" ? expectToMoveAsWithoutSleep<GpuSolver>() : expectToMoveAsWithoutSleep<CpuSolver>();
}

TEST_P(ThinWalls, AwakeAllTheyMoveAsWithoutSleepToTheBit) {
  GetParam() == "gpu" ? expectToMoveAsWithoutSleepToTheBit<GpuSolver>()
                      : expectToMoveAsWithoutSleepToTheBit<CpuSolver>();
}
