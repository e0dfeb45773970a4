// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cells in thin walls on the backends, against the float64 reference.
#include <cmath>
#include <random>

#include "support/random_state.h"
#include "support/solver_rig.h"
#include "viscera/model/body/wall_cells.h"

using namespace viscera;
using namespace viscera::test;

namespace {

// Relative to the largest value: float32 rounds at 6e-8; forces of rows are sums of second differences on the way.
constexpr double kWallFloat32Displacement = 4e-6;
constexpr double kWallFloat32Velocity = 2e-5;
constexpr double kWallFloat32Energy = 2e-5;
constexpr double kWallSpacing_m = 0.01;

/// A bowl: half a hollow ball of 0.8 cells, over three bricks along each axis.
Body bowl(double nu = 0.3) {
  Body body = ofLaw(momentBody({11, 10, 6}, kWallSpacing_m,
                               [](const Vector3d& p) {
                                 const double r = (p - Vector3d(5.4, 5.1, 5.7)).norm();
                                 return r < 4.9 && r > 4.1 && p.z() < 5.7;
                               }),
                    nu);
  return body;
}

/// A plate of a thickness in cells, turned about two axes.
Body plate(double cells, double nu = 0.3) {
  const Vector3d normal = Vector3d(0.35, 0.5, 0.8).normalized();
  return ofLaw(
      momentBody({7, 6, 8}, kWallSpacing_m,
                 [&](const Vector3d& p) { return std::abs((p - Vector3d(3.5, 3, 4)).dot(normal)) < 0.5 * cells; }),
      nu);
}

class Walls : public OnBackend {
 protected:
  void expectLikeReference(const Model& model, double size_m, int substeps) {
    const Vector3d gravity(0.3, -0.2, -9.81);
    const auto solver = make(model, sceneFor(model, substeps, {}, gravity));
    ReferenceSolver reference(model, gravity, static_cast<float>(solver->dt_s()));
    ASSERT_EQ(solver->substeps(), substeps);
    expectSameTick(*solver, reference, randomState(model, size_m, 0.1, 7), kWallFloat32Displacement,
                   kWallFloat32Velocity);
  }
};

INSTANTIATE_TEST_SUITE_P(Backends, Walls, ::testing::ValuesIn(backendNames()), backendSuffix);

}  // namespace

TEST_P(Walls, MatchTheReference) {
  for (const double nu : {0.0, 0.3, 0.49}) {
    for (const Body& body : {bowl(nu), plate(0.6, nu), plate(2.2, nu)}) {
      SCOPED_TRACE(::testing::Message() << nu << ", " << wallCells(body).size() << " cells in walls");
      ASSERT_GT(wallCells(body).size(), 20u);
      expectLikeReference(modelOf({body}), 0.02 * kWallSpacing_m, 5);
    }
  }
}

TEST_P(Walls, MatchTheReferenceAtLargeStrains) {
  for (const double size : {0.2, 0.5, 0.9}) {
    SCOPED_TRACE(size);
    expectLikeReference(modelOf({bowl()}), size * kWallSpacing_m, 1);
    expectLikeReference(modelOf({plate(0.6)}), size * kWallSpacing_m, 1);
  }
}

TEST_P(Walls, DampingMatchesTheReference) {
  Body body = bowl();
  body.material.dashpot_ratio = 0.2;
  expectLikeReference(modelOf({body}), 0.05 * kWallSpacing_m, 5);
}

TEST_P(Walls, TheirEnergyIsMeasured) {
  for (const double size : {0.05, 0.2}) {
    for (const Body& body : {bowl(), bowl(0.49), plate(0.6)}) {
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
    }
  }
}

/// A blade through the bowl takes rows away: what is left matches, and its energy does.
TEST_P(Walls, MatchTheReferenceOnceCut) {
  constexpr int kSubsteps = 5;
  Body body = bowl();
  body.material.dashpot_ratio = 0.2;
  const Model model = modelOf({body});
  std::vector<StylusConfig> styluses(2);
  styluses[0].cut.blade_length_m = 0.2;
  styluses[0].cut.blade_side = BladeSide::kAhead;
  const auto solver = make(model, sceneFor(model, kSubsteps, styluses));
  const HostState start = randomState(model, 0.02 * kWallSpacing_m, 0.05, 7);
  solver->writeState(start);
  ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()));
  load(reference, start);
  tickBoth(*solver, reference, styluses, kSubsteps, tool(ToolMode::kCut, {-0.02, 0.0532, 0.1}, {0.06, 0.0532, 0.1}));
  tickBoth(*solver, reference, styluses, kSubsteps, {});
  const HostState end = solver->readState();
  expectSameState(end, reference, 2 * kWallFloat32Displacement, 2 * kWallFloat32Velocity);
  layout::TickStats stats{};
  while (solver->pollStats(stats, true)) {
  }
  const double truth_j = reference.elasticEnergy();
  EXPECT_NEAR(static_cast<double>(stats.elastic_j), truth_j, kWallFloat32Energy * std::abs(truth_j));
  EXPECT_GT(stats.springs_cut, 50u);
}
