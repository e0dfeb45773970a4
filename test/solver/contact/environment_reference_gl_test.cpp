// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// External effects on the tissue, kernel by kernel, against the float64 reference, which is written from physics.md 8.
#include "solver/reference/reference_ticks.h"
#include "support/loose_cloth.h"
#include "support/momentum.h"
#include "support/random_state.h"
#include "support/solver_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kEnvironmentReferenceSpacing_m = 0.01;
const Vector3d kEnvironmentReferenceGravity(0, 0, -9.81);
// Of the largest value. Positions of obstacles and nodes are absolute in the kernels: 6e-9 m of 0.1 m, and
// displacements are 1e-3 m and more. Velocities have the error that a substep of 1e-3 s makes of that (measured: 7e-7).
constexpr double kAfterOne = 5e-6;
// After a hundred substeps, including the persistent error of sliding without friction (measured: 2e-4 there, 3e-5
// elsewhere).
constexpr double kAfterHundred = 1e-3;
// Of the exchanged momentum: float32 sums of that many terms.
constexpr double kEnvironmentReferenceMomentum = 1e-4;

class SurroundReference : public OnBackend {
 protected:
  /// Steps both in parallel and compares them.
  void compare(const Model& model, const Scene& scene, const HostState& start, int ticks = 100) {
    const auto solver = make(model, scene);
    solver->writeState(start);
    ReferenceTicks reference(model, scene);
    reference.load(start.displacement_m, start.velocity_m_per_s);
    Obstacles obstacles(scene.obstacles);
    const double tick_s = 1 / scene.solver.tick_hz;
    std::vector<Vector3d> given(scene.obstacles.size(), Vector3d::Zero()), truth = given;
    for (int t = 0; t < ticks; ++t) {
      obstacles.advance(t * tick_s, tick_s);
      solver->step({}, obstacles.motions());
      reference.step({}, obstacles.motions());
      const layout::TickStats stats = lastStats(*solver);
      for (size_t o = 0; o < given.size(); ++o) {
        given[o] += xyz(stats.obstacle_impulse[o]);
        truth[o] += reference.obstacleImpulse(o);
      }
      if (t != 0 && t != ticks - 1) continue;
      SCOPED_TRACE(t);
      const double tolerance = t == 0 ? kAfterOne : kAfterHundred;
      const HostState state = solver->readState();
      const ReferenceSolver& now = reference.solver();
      EXPECT_LT(relativeError(state.displacement_m, now.u_m, now.active), tolerance);
      EXPECT_LT(relativeError(state.velocity_m_per_s, now.v_m_per_s, now.active), tolerance);
      for (size_t o = 0; o < given.size(); ++o) {
        EXPECT_LT((given[o] - truth[o]).norm(), tolerance * std::max(truth[o].norm(), 1e-6)) << "obstacle " << o;
        if (t == ticks - 1) {
          EXPECT_GT(truth[o].norm(), 0) << "obstacle " << o << " met nothing";
        }
      }
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Backends, SurroundReference, ::testing::ValuesIn(backendKinds()), backendSuffix);

ObstacleConfig environmentReferenceObstacle(ObstacleShape shape, const Vector3d& position_m) {
  ObstacleConfig out;
  out.shape = shape;
  out.position_m = position_m;
  out.friction = 0.4;
  out.restitution = 0.3;
  return out;
}

/// Adds a sheet that falls obliquely.
HostState falling(const Model& model, size_t body, const Vector3d& at_m, const Vector3d& v_m_per_s, HostState state) {
  place(model, body, {at_m, rotationFromDegrees({7, 11, 0})}, v_m_per_s, state);
  return state;
}

}  // namespace

TEST_P(SurroundReference, WindInGusts) {
  const Model model = modelOf({clothBody(6, 7, kEnvironmentReferenceSpacing_m)});
  Scene scene = sceneFor(model, 1);
  scene.environment.wind.velocity_m_per_s = Vector3d(2, -1, 5);
  scene.environment.wind.gust_ratio = 0.6;
  scene.environment.wind.gust_period_s = 50 / scene.solver.tick_hz;
  compare(model, scene, randomState(model, 0.1 * kEnvironmentReferenceSpacing_m, 0.05, 3));
}

TEST_P(SurroundReference, ForcesOnBodies) {
  Body pushed = clothBody(5, 6, kEnvironmentReferenceSpacing_m);
  pushed.force_n = Vector3d(0.02, -0.01, 0.03);
  const Model model = modelOf({pushed});
  compare(model, sceneFor(model, 1), randomState(model, 0.1 * kEnvironmentReferenceSpacing_m, 0.05, 5));
}

TEST_P(SurroundReference, EveryShapeOfObstacleWithFrictionRestitutionAndMotion) {
  for (const ObstacleShape shape :
       {ObstacleShape::kPlane, ObstacleShape::kSphere, ObstacleShape::kCapsule, ObstacleShape::kBox}) {
    SCOPED_TRACE(static_cast<int>(shape));
    Body body = boxBody({3, 3, 2}, kEnvironmentReferenceSpacing_m);
    const Model model = modelOf({body});
    Scene scene = sceneFor(model, 1, {}, kEnvironmentReferenceGravity);
    ObstacleConfig under =
        environmentReferenceObstacle(shape, Vector3d(0.004, -0.003, shape == ObstacleShape::kPlane ? -0.012 : -0.03));
    under.radius_m = 0.021;
    under.length_m = 0.03;
    under.size_m = Vector3d(0.031, 0.033, 0.041);
    under.rotation_deg = shape == ObstacleShape::kCapsule ? Vector3d(90, 0, 20) : Vector3d(3, 5, 0);
    under.velocity_m_per_s = Vector3d(0.1, 0.05, 0.02);
    under.rotation_deg_per_s = Vector3d(20, -30, 40);
    scene.obstacles = {under};
    compare(model, scene, falling(model, 0, {0, 0, 0.003}, {0.3, 0.1, -1.0}, restState(model)));
  }
}

TEST_P(SurroundReference, ContactsOfTwoBodiesWithFrictionAndRestitution) {
  const Model model =
      modelOf({clothBody(5, 5, kEnvironmentReferenceSpacing_m), clothBody(6, 6, 0.8 * kEnvironmentReferenceSpacing_m)});
  Scene scene = sceneFor(model, 1);
  scene.collision.enabled = true;
  scene.collision.friction = 0.4;
  scene.collision.restitution = 0.5;
  const HostState start = falling(model, 1, {0.002, 0.001, 0.014}, {0.2, 0.1, -0.5}, restState(model));
  compare(model, scene, start);
}

TEST_P(SurroundReference, ContactsOfABodyWithItself) {
  const Model model = modelOf({clothBody(5, 12, kEnvironmentReferenceSpacing_m)});
  Scene scene = sceneFor(model, 1);
  scene.collision.enabled = true;
  HostState start = restState(model);
  // Folded: one half is turned over the other and falls on it.
  for (const uint32_t slot : model.bodies[0].lattice.active_slots) {
    const Vector3d rest = restPosition(model.bodies[0], slot);
    if (rest.x() <= 0) continue;
    start.displacement_m[slot] = vec4(Vector3d(-2 * rest.x() + 0.0013, 0.0011, std::min(rest.x(), 0.012)));
    start.velocity_m_per_s[slot] = vec4({0, 0, -0.4});
  }
  compare(model, scene, start);
}

TEST_P(SurroundReference, MomentumThatANodeGetsIsThatOfTheObstacle) {
  const Model model = modelOf({looseCloth(6, 6, kEnvironmentReferenceSpacing_m)});
  Scene scene = sceneFor(model, 4);
  scene.obstacles = {environmentReferenceObstacle(ObstacleShape::kPlane, Vector3d(0, 0, -0.01))};
  const HostState start = falling(model, 0, {0, 0, 0.002}, {0.3, 0.1, -1.0}, restState(model));
  for (const Integrator integrator : {Integrator::kLeapfrog, Integrator::kPd}) {
    scene.solver.integrator = integrator;
    scene.solver.iterations = 200;
    const auto solver = make(model, scene);
    solver->writeState(start);
    Vector3d given = Vector3d::Zero();
    for (int t = 0; t < 25; ++t) {
      solver->step({});
      layout::TickStats stats{};
      while (solver->pollStats(stats, true)) given += xyz(stats.obstacle_impulse[0]);
    }
    const Vector3d gained = momentum(model, solver->readState()) - momentum(model, start);
    EXPECT_GT(gained.z(), 0.1 * std::abs(momentum(model, start).z()));
    EXPECT_LT((given - gained).norm(), kEnvironmentReferenceMomentum * gained.norm()) << static_cast<int>(integrator);
  }
}

TEST_P(SurroundReference, PdSolvesForObstaclesLikeTheReference) {
  for (const double friction : {0.0, 0.3}) {
    SCOPED_TRACE(friction);
    const Model model = modelOf({boxBody({2, 2, 2}, kEnvironmentReferenceSpacing_m)});
    Scene scene = sceneWith(Integrator::kPd, model, 1, 3, 600, {}, kEnvironmentReferenceGravity);
    scene.obstacles = {environmentReferenceObstacle(ObstacleShape::kPlane, Vector3d(0, 0, -0.001)),
                       environmentReferenceObstacle(ObstacleShape::kSphere, Vector3d(-0.02, 0.015, 0.015))};
    scene.obstacles[0].rotation_deg = Vector3d(4, 6, 0);
    scene.obstacles[1].radius_m = 0.019;
    scene.obstacles[1].velocity_m_per_s = Vector3d(0.3, 0, 0);
    for (ObstacleConfig& o : scene.obstacles) o.friction = friction;
    HostState start = restState(model);
    for (const uint32_t slot : model.bodies[0].lattice.active_slots)
      start.velocity_m_per_s[slot] = vec4({0.2, 0.1, -0.3});
    compare(model, scene, start, 40);
  }
}

TEST_P(SurroundReference, PdSolvesForContactsOfNodesLikeTheReference) {
  for (const double friction : {0.0, 0.3}) {
    SCOPED_TRACE(friction);
    Body lower = boxBody({2, 2, 1}, kEnvironmentReferenceSpacing_m),
         upper = boxBody({1, 1, 1}, kEnvironmentReferenceSpacing_m);
    upper.lattice.origin_m = Vector3d(0.0035, 0.004, 0.0215);
    const Model model = modelOf({lower, upper});
    Scene scene = sceneWith(Integrator::kPd, model, 1, 3, 800, {}, kEnvironmentReferenceGravity);
    scene.obstacles = {environmentReferenceObstacle(ObstacleShape::kPlane, Vector3d::Zero())};
    scene.collision.enabled = true;
    scene.collision.friction = friction;
    scene.collision.restitution = 0.4;
    HostState start = restState(model);
    for (const uint32_t slot : model.bodies[1].lattice.active_slots)
      start.velocity_m_per_s[model.slotOffset(1) + slot] = vec4({0.1, 0.05, -0.6});
    compare(model, scene, start, 12);
  }
}
