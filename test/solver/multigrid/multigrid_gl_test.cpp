// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Integrator multigrid on either backend.
#include <gtest/gtest.h>

#include "solver/multigrid/steps/equilibrium.h"
#include "solver/reference/statics.h"
#include "support/held_blocks.h"
#include "support/networks.h"
#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/body/elasticity.h"

namespace viscera::test {

namespace {

/// Largest distance from where leapfrog has a node in any of 30 ticks, over the depth of the swing.
/// @param substeps  of multigrid per tick
double worstOffLeapfrog(const std::string& backend, const Model& model, int substeps) {
  Scene scene = sceneOf(Integrator::kMultigrid);
  scene.solver.substeps = substeps;
  const auto multigrid = makeBackend(backend, model, scene);
  const auto leapfrog = makeCpu("", model, sceneOf(Integrator::kLeapfrog));
  double worst = 0, deepest = 0;
  for (int t = 0; t < 30; ++t) {
    multigrid->step({});
    leapfrog->step({});
    const HostState state = leapfrog->readState();
    worst = std::max(worst, largestOff(model, multigrid->readState(), state));
    deepest = std::min(deepest, lowest(model, state));
  }
  return -worst / deepest;
}

}  // namespace

class MultigridOn : public OnBackend {};
INSTANTIATE_TEST_SUITE_P(Backends, MultigridOn, ::testing::ValuesIn(backendKinds()), backendSuffix);

TEST_P(MultigridOn, FollowsLeapfrogToSecondOrder) {
  // E 20 kPa: the swing takes some ten ticks. One step per tick leaves a sixth of it in the worst tick of 30, which is
  // what TR-BDF2 leaves at that length; leapfrog's own error is below 0.002.
  constexpr double kOfTheSwing = 0.2, kOfTheSwingInQuarters = 0.03;
  for (const Cells kind : {Cells::kSprings, Cells::kMoments}) {
    for (const double nu : {0.25, 0.45}) {
      const Model model = modelOf({block(8, 2e4, nu, kind)});
      EXPECT_LT(worstOffLeapfrog(GetParam(), model, 1), kOfTheSwing) << "nu " << nu;
      EXPECT_LT(worstOffLeapfrog(GetParam(), model, 4), kOfTheSwingInQuarters) << "nu " << nu;
    }
  }
}

TEST_P(MultigridOn, ComesToRestInTheStaticState) {
  constexpr double kOfTheSag = 2e-3;  // what float32 forces leave, as in MultigridEquilibrium
  for (const Cells kind : {Cells::kSprings, Cells::kMoments}) {
    for (const double nu : {0.25, 0.49}) {
      Body body = block(6, 5e4, nu, kind);
      body.material.drag_per_s = 30;
      const Model model = modelOf({body});
      ReferenceSolver reference(model, kGravity, 1e-3);
      solveStatics(reference, {});
      const auto solver = make(model, sceneOf(Integrator::kMultigrid));
      for (int t = 0; t < 120; ++t) solver->step({});
      EXPECT_LT(largestOff(model, solver->readState(), reference.state()),
                -kOfTheSag * lowest(model, reference.state()))
          << "nu " << nu;
    }
  }
}

TEST_P(MultigridOn, EnergyNeverGrowsWithoutLoad) {
  constexpr double kRounding = 1e-4;  // of the start, over all ticks: float32 sums of energies
  for (const double nu : {0.25, 0.49}) {
    for (const double stiff : {2e3, 2e5}) {
      Body body = block(6, stiff, nu, Cells::kMoments);
      const Model model = modelOf({body});
      Scene scene = sceneOf(Integrator::kMultigrid);
      scene.environment.gravity_m_per_s2.setZero();
      const auto solver = make(model, scene);
      HostState start = randomState(model, 0.2 * body.lattice.spacing_m, 1, 11);
      for (const uint32_t slot : model.bodies[0].lattice.active_slots) {
        if (isFixed(start.nodes[slot])) start.displacement_m[slot] = start.velocity_m_per_s[slot] = {};
      }
      solver->writeState(start);
      double before_j = energyOf(model, start);
      const double start_j = before_j;
      for (int t = 0; t < 40; ++t) {
        solver->step({});
        const double after_j = energyOf(model, solver->readState());
        ASSERT_LE(after_j, before_j + kRounding * start_j) << "nu " << nu << ", E " << stiff << ", tick " << t;
        before_j = after_j;
      }
    }
  }
}

TEST_P(MultigridOn, EnergyStaysBelowItsStartFromWildStarts) {
  for (const double fraction : {1.0, 10.0, 100.0})
    expectEnergyBound(GetParam(), Integrator::kMultigrid, 0.25, fraction);
  expectEnergyBound(GetParam(), Integrator::kMultigrid, 0.45, 10);
  expectEnergyBound(GetParam(), Integrator::kMultigrid, 0.25, 10, 20, Cells::kMoments);
}

TEST_P(MultigridOn, HeldNodesGoWithTheHandAndFixedOnesStay) {
  const PullAndProbe tools;
  Body body = block(8, 2e4, 0.45);
  const Model model = modelOf({body});
  const auto solver = make(model, sceneOf(Integrator::kMultigrid, tools.styluses));
  const Lattice& lattice = model.bodies[0].lattice;
  const Vector3d corner(0.1, 0.1, 0.1);
  uint32_t held = 0;
  for (int t = 0; t < 5; ++t) {
    ToolMotions motions =
        tool(ToolMode::kGrab, corner + Vector3d(0, 0, 0.002 * t), corner + Vector3d(0, 0, 0.002 * (t + 1)));
    motions[0].hold_begins = t == 0;
    solver->step(motions);
    const HostState state = solver->readState();
    held = 0;
    for (const uint32_t slot : lattice.active_slots) {
      const Vector3d u = xyz(state.displacement_m[slot]);
      if (isFixed(state.nodes[slot])) {
        EXPECT_EQ(u, Vector3d::Zero());
      }
      if ((state.nodes[slot].lo & layout::kGrabMask) == 0) continue;
      ++held;
      EXPECT_LT((u - Vector3d(0, 0, 0.002 * (t + 1))).norm(), 1e-7);  // float32 of 10 cm
    }
  }
  EXPECT_GT(held, 0u);
}

TEST_P(MultigridOn, AHandFeelsTheForceOfWhatItHolds) {
  constexpr double kForce = 0.01;  // of the static force: what pd is held to with probes
  for (const Cells kind : {Cells::kSprings, Cells::kMoments}) {
    for (const double nu : {0.25, 0.45}) {
      StylusConfig stylus;
      stylus.grab.radius_m = 0.012;
      Body body = block(8, 2e4, nu, kind);
      body.material.drag_per_s = 30;
      const Model model = modelOf({body});
      const Lattice& lattice = model.bodies[0].lattice;
      Scene scene = sceneOf(Integrator::kMultigrid, {stylus});
      scene.environment.gravity_m_per_s2.setZero();
      const auto solver = make(model, scene);
      const Vector3d corner = lattice.origin_m + Vector3d(0.1, 0.1, 0.1), way(0, 0, 0.005);
      for (int t = 0; t < 120; ++t) {
        ToolMotions motions =
            tool(ToolMode::kGrab, corner + std::min(1.0, t / 20.0) * way, corner + std::min(1.0, (t + 1) / 20.0) * way);
        motions[0].hold_begins = t == 0;
        solver->step(motions);
      }
      const layout::TickStats stats = lastStats(*solver);
      const Vector3d felt = xyz(stats.impulse[0]) / kTick_s;
      std::vector<PrescribedDof> prescribed;
      const HostState state = solver->readState();
      for (const uint32_t slot : lattice.active_slots) {
        if ((state.nodes[slot].lo & layout::kGrabMask) == 0) continue;
        for (int axis = 0; axis < 3; ++axis) prescribed.push_back({slot, axis, way[axis]});
      }
      ASSERT_FALSE(prescribed.empty());
      ReferenceSolver truth(model, Vector3d::Zero(), 1);
      solveStatics(truth, prescribed);
      Vector3d wanted = Vector3d::Zero();
      for (size_t i = 0; i < prescribed.size(); i += 3) wanted += reactions(truth)[prescribed[i].slot];
      EXPECT_LT((felt - wanted).norm(), kForce * wanted.norm()) << "nu " << nu << ": " << felt.transpose();
    }
  }
}

TEST_P(MultigridOn, WhatStrokesTheTissueDampsNoMoreThanATickDoes) {
  // Two ends of a block swing; a probe that rests at a third place makes steps that know contacts. TR-BDF2 follows all
  // of them alike: steps of implicit Euler would leave a third of the swing.
  constexpr double kOfTheSwing = 0.05;
  const auto swingAfter = [this](bool touched) {
    StylusConfig stylus;
    stylus.probe.radius_m = 0.004;
    Body body = block(8, 2e4, 0.25);
    const Model model = modelOf({body});
    const auto solver = make(model, sceneOf(Integrator::kMultigrid, {stylus}));
    // At the held face, where nothing moves.
    const ToolMotions motions = probeAt(model.bodies[0].lattice.origin_m + Vector3d(0.0125, 0.05, 0.1035));
    double low = 0, high = -1;
    for (int t = 0; t < 40; ++t) {
      solver->step(touched ? motions : ToolMotions{});
      if (t < 20) continue;
      low = std::min(low, lowest(model, solver->readState()));
      high = std::max(high, lowest(model, solver->readState()));
    }
    return high - low;
  };
  const double alone = swingAfter(false);
  EXPECT_NEAR(swingAfter(true), alone, kOfTheSwing * alone);
}

TEST_P(MultigridOn, AForceOnTheBodyHoldsItWhereItWouldInAnEquilibrium) {
  constexpr double kOfTheWay = 0.01;
  Body body = block(6, 1e6, 0.25);
  body.material.drag_per_s = 30;
  body.force_n = Vector3d(0, 3, -5);
  const Model model = modelOf({body});
  Scene scene = sceneOf(Integrator::kMultigrid);
  SettleReport report;
  const HostState settled = equilibriumOf(model, scene, report);
  const auto solver = make(model, scene);
  for (int t = 0; t < 120; ++t) solver->step({});
  EXPECT_LT(largestOff(model, solver->readState(), settled), -kOfTheWay * lowest(model, settled));
}

TEST_P(MultigridOn, WhatItCannotStepIsRefusedByName) {
  const auto refusal = [this](const Model& model, const Scene& scene) {
    return messageOf<SceneError>([&] { make(model, scene); });
  };
  Scene scene = sceneOf(Integrator::kMultigrid);
  EXPECT_NE(refusal(modelOf({graphBody(20, 60, 3)}), scene).find("solver.integrator: multigrid"), std::string::npos);
  scene.collision.enabled = true;
  EXPECT_NE(refusal(modelOf({block(4, 5e3, 0.25)}), scene).find("collision.enabled"), std::string::npos);
}

/// The tick that a backend makes of a state is that of the CPU.
class MultigridGpu : public GpuTest {
 protected:
  /// Holds nodes of both backends to each other for some ticks.
  static void expectAsOnTheCpu(const Model& model, const Scene& scene) {
    // Over the largest displacement. By the same iterations: float32 sums in another order. A residual that is at the
    // tolerance to a digit may take one of both backends an iteration more, and to a part of the percent of a tick's
    // motion that systems are solved to (Multigrid.TicksAreWithinAPercentOfTheirMotion).
    // Corners of slivers, which nothing damps, let the first grow threefold a tick.
    constexpr double kSameIterations = 3e-5, kOthers = 2e-3;
    constexpr int kTicks = 3;
    const std::unique_ptr<Ticks> gpu = makeBackend("gpu", model, scene), cpu = makeCpu("", model, scene);
    double worst = 0, largest = 0;
    for (int t = 0; t < kTicks; ++t) {
      gpu->step({});
      cpu->step({});
      const HostState state = cpu->readState();
      worst = std::max(worst, largestOff(model, gpu->readState(), state));
      largest = std::max(largest, largestOff(model, state, restState(model)));
    }
    EXPECT_GT(gpu->work().iterations, 0u);
    const bool same = gpu->work().iterations == cpu->work().iterations;
    EXPECT_LT(worst / largest, same ? kSameIterations : kOthers)
        << gpu->work().iterations << " iterations, " << cpu->work().iterations << " on the CPU";
  }
  /// A ball, in which cells are tissue in part. @param hollow  radius of its cavity, in cells
  static Body ball(double hollow = 0) {
    Body out = momentBody({8, 8, 8}, 0.01, [hollow](const Vector3d& p) {
      const double r = (p - Vector3d::Constant(4)).norm();
      return r < 3.7 && r >= hollow;
    });
    out.material.drag_per_s = 0;
    for (const uint32_t slot : out.lattice.active_slots) {
      if (out.lattice.nodeAt(slot).x() < 3) out.lattice.nodes[slot].lo |= layout::kFixedBit;
    }
    return out;
  }
};

TEST_F(MultigridGpu, StepsAsTheCpuDoes) {
  std::vector<Body> bodies;
  for (const double nu : {0.25, 0.45}) {
    bodies.push_back(block(7, 2e4, nu));
    bodies.push_back(block(7, 2e4, nu, Cells::kMoments));
    bodies.push_back(ball());
    bodies.back().material.poisson_ratio = nu;
  }
  bodies.push_back(block(7, 2e4, 0.1, Cells::kMoments));
  bodies.push_back(twoPartBody());
  bodies.push_back(ball(2.4));
  bodies.back().material.thin_walls = true;
  ASSERT_GT(cellMoments(bodies.back()).bends.size(), 50u);
  for (const double dashpot_ratio : {0.0, 0.1}) {
    for (size_t i = 0; i < bodies.size(); ++i) {
      SCOPED_TRACE(::testing::Message() << "body " << i << ", dashpot " << dashpot_ratio);
      Body body = bodies[i];
      body.material.dashpot_ratio = dashpot_ratio;
      body.material.drag_per_s = 50 * dashpot_ratio;
      expectAsOnTheCpu(modelOf({body}), sceneOf(Integrator::kMultigrid));
    }
  }
  expectAsOnTheCpu(modelOf(bodies), sceneOf(Integrator::kMultigrid));
}

TEST_F(MultigridGpu, EveryRunHasTheSameBits) {
  const PullAndProbe tools;
  Body body = block(8, 5e4, 0.45, Cells::kMoments);
  const Model model = modelOf({body});
  const auto hashAfter = [&](Ticks& solver) {
    for (int t = 0; t < 6; ++t) solver.step(tools.motions(t, 0.1));
    return stateHash(model, solver.readState());
  };
  const auto first = makeBackend("gpu", model, sceneOf(Integrator::kMultigrid, tools.styluses));
  const auto second = makeBackend("gpu", model, sceneOf(Integrator::kMultigrid, tools.styluses));
  const uint64_t hash = hashAfter(*first);
  EXPECT_EQ(hashAfter(*second), hash);
  first->reset();
  EXPECT_EQ(hashAfter(*first), hash);
}

TEST_F(MultigridGpu, CutsAsTheCpuDoesAndRebuildsItsLevels) {
  constexpr double kOfTheWay = 1e-3;  // a flap of a few springs turns with less than a block of many bends with
  StylusConfig stylus;
  stylus.cut.blade_length_m = 0.2;
  stylus.cut.blade_side = BladeSide::kAhead;
  const Model model = modelOf({block(10, 5e4, 0.4, Cells::kMoments)});
  const Scene scene = sceneOf(Integrator::kMultigrid, {stylus});
  const std::unique_ptr<Ticks> gpu = makeBackend("gpu", model, scene), cpu = makeCpu("", model, scene);
  const Vector3d from = model.bodies[0].lattice.origin_m + Vector3d(0.034, 0.0531, 0.2);
  const ToolMotions motions = tool(ToolMode::kCut, from, from + Vector3d(0.08, 0, 0));
  const auto iterationsIn = [&](int ticks) {
    const uint64_t before[] = {gpu->work().iterations, cpu->work().iterations};
    for (int t = 0; t < ticks; ++t) {
      gpu->step({});
      cpu->step({});
    }
    const uint64_t took = gpu->work().iterations - before[0], wanted = cpu->work().iterations - before[1];
    EXPECT_NEAR(static_cast<double>(took), static_cast<double>(wanted), 0.1 * static_cast<double>(wanted));
    return took;
  };
  gpu->step(motions);
  cpu->step(motions);
  iterationsIn(30);
  const HostState wanted = cpu->readState(), state = gpu->readState();
  EXPECT_EQ(state.nodes[0].lo, wanted.nodes[0].lo);
  EXPECT_LT(largestOff(model, state, wanted), kOfTheWay * largestOff(model, wanted, restState(model)));
  EXPECT_NE(std::count_if(state.nodes.begin(), state.nodes.end(),
                          [](const layout::NodeBits& bits) { return (bits.lo & layout::kSeveredBit) != 0; }),
            0);
  iterationsIn(20);  // past the steps in which the levels are built
}

TEST_F(MultigridGpu, GoesOnFromWhatTheGovernorPutBack) {
  // Not finite: the tick trips, the GPU puts the last good state back, and that is where the next step begins.
  Body body = block(5, 2e4, 0.25);
  const Model model = modelOf({body});
  Scene scene = sceneOf(Integrator::kMultigrid);
  scene.solver.governor = true;
  const auto solver = makeBackend("gpu", model, scene);
  for (int t = 0; t < 5; ++t) solver->step({});
  HostState wild = solver->readState();
  for (const uint32_t slot : model.bodies[0].lattice.active_slots) {
    if (!isFixed(wild.nodes[slot])) wild.velocity_m_per_s[slot] = {NAN, NAN, NAN, 0};
  }
  solver->writeState(wild);
  for (int t = 0; t < 60; ++t) solver->step({});
  const HostState state = solver->readState();
  EXPECT_GT(solver->health().trips, 0u);
  EXPECT_TRUE(isFinite(state));
  EXPECT_LT(lowest(model, state), -1e-3);  // it hangs, and did not go back to rest for good
}

}  // namespace viscera::test
