// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Equilibria, compared with the float64 reference and with the final state of the dynamics.
#include "solver/cpu/equilibrium.h"

#include <gtest/gtest.h>

#include "model/body/network_builder.h"
#include "solver/reference/statics.h"
#include "support/held_blocks.h"
#include "viscera/math/error.h"

namespace viscera::test {
namespace {

/// Of the largest displacement, as required of equilibria.
constexpr double kOfTheSag = 1e-4;
/// The same for nearly incompressible cells, with larger float32 rounding of forces.
constexpr double kOfTheSagAtNu49 = 1e-3;

TEST(Equilibrium, IsThatOfTheReference) {
  for (const Body& body : {block(6, 2e4), block(6, 2e4, 0.25), block(6, 2e4, 0.45), block(6, 2e4, 0.49)}) {
    const double nu = body.material.poisson_ratio;
    const Model model = modelOf({body});
    ReferenceSolver reference(model, kGravity, 1e-3);
    solveStatics(reference, {});
    SettleReport report;
    const HostState settled = equilibriumOf(model, sceneOf(Integrator::kLeapfrog), report);
    EXPECT_TRUE(report.settled);
    const double most = nu < 0.49 ? kOfTheSag : kOfTheSagAtNu49;
    EXPECT_LT(largestOff(model, settled, reference.state()), most * report.largest_m)
        << "nu " << nu << (body.material.law == Law::kNeoHookean ? ", law" : ", springs");
  }
}

TEST(Equilibrium, OfBodiesWithExplicitConnections) {
  Body body = block(6, 2e4);
  SettleReport lattice, links;
  const HostState a = equilibriumOf(modelOf({body}), sceneOf(Integrator::kLeapfrog), lattice);
  body.network = latticeNetwork(body);
  const Model model = modelOf({body});
  const HostState b = equilibriumOf(model, sceneOf(Integrator::kLeapfrog), links);
  EXPECT_LT(largestOff(model, a, b), 2 * kOfTheSag * lattice.largest_m) << "each is off by as much";
}

/// A force on the body acts as gravity does.
TEST(Equilibrium, IncludesForcesOnBodies) {
  Body body = block(4, 2e4, 0.3);
  const Model heavy = modelOf({body});
  body.force_n = massOf_kg(body) * kGravity;
  const Model pushed = modelOf({body});
  Scene weightless = sceneOf(Integrator::kLeapfrog);
  weightless.environment.gravity_m_per_s2.setZero();
  SettleReport report;
  const HostState a = equilibriumOf(heavy, sceneOf(Integrator::kLeapfrog), report);
  const HostState b = equilibriumOf(pushed, weightless, report);
  EXPECT_LT(largestOff(heavy, a, b), 2 * kOfTheSag * report.largest_m);
}

TEST(Equilibrium, StartsThereAndStays) {
  constexpr double kStays = 3e-4;  // of the sag: the remaining distance swings to the other side
  const Model model = modelOf({block(8, 2e4, 0.45)});
  Scene scene = sceneOf(Integrator::kLeapfrog);
  scene.solver.start = SolverStart::kEquilibrium;
  scene.solver.backend = Backend::kCpu;
  const std::unique_ptr<Solver> solver = makeSolver(model, scene, nullptr, nullptr);
  const HostState start = solver->readState();
  ASSERT_LT(lowest(model, start), -1e-3);
  for (int t = 0; t < 30; ++t) solver->step({});
  EXPECT_LT(largestOff(model, solver->readState(), start), -kStays * lowest(model, start));
  solver->reset();
  EXPECT_EQ(stateHash(model, solver->readState()), stateHash(model, start));
}

/// Thin walls, and slivers of tissue with little support: long dynamics from there move no node.
TEST(Equilibrium, OfTheShippedHeartIsWhatItsDynamicsComeTo) {
  Scene scene = parseScene(R"(
bodies:
  - name: heart
    source: phantom
    spacing_m: 0.008
    skin_spacing_m: 0.008
    material: {young_modulus_pa: 20000, density_kg_per_m3: 1060}
    fixed: [{shape: plane, point_m: [0, 0, 0.03], normal: [0, 0, -1]}]
)",
                           "heart.yaml");
  constexpr double kStays = 3e-4;
  constexpr int kTicks = 400;
  for (const double nu : {0.25, 0.45}) {
    scene.bodies[0].material.poisson_ratio = nu;
    const Model model = buildModel(scene);
    SettleReport report;
    const HostState settled = equilibriumOf(model, scene, report);
    EXPECT_TRUE(report.settled) << "nu " << nu;
    EXPECT_LT(report.residual, kSettled) << "nu " << nu;
    Scene dynamic = scene;
    dynamic.solver.start = SolverStart::kEquilibrium;
    dynamic.solver.backend = Backend::kCpu;
    const std::unique_ptr<Solver> solver = makeSolver(model, dynamic, nullptr, nullptr);
    for (int t = 0; t < kTicks; ++t) solver->step({});
    EXPECT_LT(largestOff(model, solver->readState(), settled), kStays * report.largest_m) << "nu " << nu;
  }
}

TEST(Equilibrium, OfWhatNothingPullsIsRest) {
  const Model model = modelOf({block(4, 2e4)});
  Scene scene = sceneOf(Integrator::kLeapfrog);
  scene.environment.gravity_m_per_s2.setZero();
  SettleReport report;
  equilibriumOf(model, scene, report);
  EXPECT_TRUE(report.settled);
  EXPECT_EQ(report.largest_m, 0);
}

TEST(Equilibrium, WhatNothingHoldsHasNone) {
  const Model model = modelOf({boxBody({3, 3, 3}, 0.01)});
  SettleReport report;
  EXPECT_THROW(equilibriumOf(model, sceneOf(Integrator::kLeapfrog), report), SceneError);
}

TEST(Equilibrium, OfALoosePieceThereIsNone) {
  Body body = momentBody({7, 2, 2}, 0.01, [](const Vector3d& at) { return at.x() < 3 || at.x() > 4; });
  for (const uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).x() == 0) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  const Model model = modelOf({body});
  SettleReport report;
  try {
    equilibriumOf(model, sceneOf(Integrator::kLeapfrog), report);
    FAIL() << "a piece falls for ever";
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("body 'part': a piece of 36 nodes"), std::string::npos) << error.what();
  }
  EXPECT_EQ(report.substeps, 0);
}

}  // namespace
}  // namespace viscera::test
