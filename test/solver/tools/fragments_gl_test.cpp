// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isolated pieces come to rest at solver.sleep_distance_m, whatever pushes them.
#include "math/float_bits.h"
#include "solver/reference/reference_ticks.h"
#include "support/loose_cloth.h"
#include "support/solver_rig.h"
#include "viscera/math/state_hash.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kSleep_m = 0.05;
constexpr double kBeyond_m = 1e-4;  ///< a node is stopped in the substep in which it gets there
constexpr double kTime_s = 2;       ///< a tenth of it is enough to get there

class Fragments : public OnSolver {
 protected:
  /// Steps for kTime_s. @return measurements of the last tick
  layout::TickStats after(const Model& model, Scene scene) {
    scene.solver.sleep_distance_m = kSleep_m;
    solver_ = make(model, scene);
    layout::TickStats stats{};
    for (int t = 0; t < std::lround(kTime_s * scene.solver.tick_hz); ++t) {
      solver_->step({});
      while (solver_->pollStats(stats, true)) {
      }
    }
    return stats;
  }
  void expectAtRest(const Model& model, const layout::TickStats& stats, float most_m_per_s = 0) {
    EXPECT_LE(floatFromBits(stats.max_speed_bits), most_m_per_s);
    const HostState state = solver_->readState();
    for (const uint32_t slot : model.bodies[0].lattice.active_slots) {
      EXPECT_LT(xyz(state.displacement_m[slot]).norm(), kSleep_m + kBeyond_m);
      EXPECT_GT(xyz(state.displacement_m[slot]).norm(), 0.5 * kSleep_m);
    }
  }
  std::unique_ptr<TissueStepper> solver_;
};

INSTANTIATE_TEST_SUITE_P(Backends, Fragments, solversUnderTest({Integrator::kLeapfrog, Integrator::kPd}), solverSuffix);

}  // namespace

TEST_P(Fragments, ThatAForcePushesLieWhereTheySleep) {
  Body body = boxBody({2, 2, 2}, 0.01);
  body.force_n = Vector3d(0.02, 0, 0.05);
  const Model model = modelOf({body});
  expectAtRest(model, after(model, sceneFor(model, 10)));
}

TEST_P(Fragments, ThatTheWindCarriesLieWhereTheySleep) {
  const Model model = modelOf({looseCloth(3, 3, 0.01)});
  Scene scene = sceneFor(model, 20);
  scene.environment.wind.velocity_m_per_s = Vector3d(0, 0, 2);
  expectAtRest(model, after(model, scene));
}

/// A slope on which they slide down and out.
TEST_P(Fragments, ThatSlideOffAnObstacleLieWhereTheySleep) {
  const Model model = modelOf({boxBody({2, 2, 2}, 0.01)});
  Scene scene = sceneFor(model, 10, {}, Vector3d(0, 0, -9.81));
  ObstacleConfig slope;
  slope.rotation_deg = Vector3d(0, 40, 0);
  slope.friction = 0;
  slope.position_m = Vector3d(0, 0, -0.02);
  scene.obstacles = {slope};
  constexpr float kCreep_m_per_s = 1e-5f;  // what still leans on the slope settles; solver.sleep_speed_m_per_s
  expectAtRest(model, after(model, scene), kCreep_m_per_s);
}

namespace {

constexpr double kStep_m = 0.002, kOffset_m = 2 * kSleep_m;  ///< displacement of a stylus, per tick and in total
constexpr double kFloat_m = 1e-7;                            ///< float32 of kOffset_m, a few times

/// Returns a block that a stylus holds by all its nodes and carries along x.
Scene carryingScene(const Model& model, double sleep_m) {
  StylusConfig stylus;
  stylus.grab.radius_m = 0.1;  // all of it
  Scene scene = sceneFor(model, 10, {stylus}, Vector3d(0, 0, -9.81));
  scene.solver.sleep_distance_m = sleep_m;
  return scene;
}
template <class Step>
void carry(const Step& step) {
  for (int t = 0; t < std::lround(kOffset_m / kStep_m); ++t) {
    ToolMotions motions = tool(ToolMode::kGrab, {kStep_m * t, 0, 0}, {kStep_m * (t + 1), 0, 0});
    motions[0].hold_begins = t == 0;
    step(motions);
  }
}

class HeldFragments : public OnSolver {
 protected:
  struct Carried {
    HostState state;
    Vector3d given_n_s{0, 0, 0};  ///< momentum that the stylus gave the tissue
  };
  Carried carried(const Model& model, double sleep_m) const {
    const auto solver = make(model, carryingScene(model, sleep_m));
    Carried out;
    layout::TickStats stats{};
    carry([&](const ToolMotions& motions) {
      solver->step(motions);
      while (solver->pollStats(stats, true)) out.given_n_s += xyz(stats.impulse[0]);
    });
    EXPECT_EQ(stats.grabbed[0], model.bodies[0].lattice.active_slots.size());
    out.state = solver->readState();
    return out;
  }
};

INSTANTIATE_TEST_SUITE_P(Backends, HeldFragments,
                         solversUnderTest({Integrator::kLeapfrog, Integrator::kVerletPaper, Integrator::kPd}),
                         solverSuffix);

}  // namespace

/// The sleep distance does not affect held fragments: neither their motion nor the force on the stylus.
TEST_P(HeldFragments, GoWithTheToolBeyondWhereTheyWouldSleep) {
  const Model model = modelOf({boxBody({2, 2, 2}, 0.01)});
  const Carried near = carried(model, 1e6), far = carried(model, kSleep_m);
  for (const uint32_t slot : model.bodies[0].lattice.active_slots)
    EXPECT_LT((xyz(far.state.displacement_m[slot]) - Vector3d(kOffset_m, 0, 0)).norm(), kFloat_m) << slot;
  EXPECT_EQ(stateHash(model, far.state), stateHash(model, near.state));
  EXPECT_EQ(far.given_n_s, near.given_n_s);
  EXPECT_GT(far.given_n_s.norm(), 0);
}

TEST(HeldFragmentsOfTheReference, GoWithTheToolBeyondWhereTheyWouldSleep) {
  const Model model = modelOf({boxBody({2, 2, 2}, 0.01)});
  ReferenceTicks reference(model, carryingScene(model, kSleep_m));
  carry([&](const ToolMotions& motions) { reference.step(motions); });
  for (const uint32_t slot : model.bodies[0].lattice.active_slots)
    EXPECT_LT((reference.solver().u_m[slot] - Vector3d(kOffset_m, 0, 0)).norm(), kFloat_m) << slot;
}
