// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Contacts between nodes are part of the solution of an implicit substep of any length: resting bodies are supported.
#include "solver/contact/environment.h"
#include "support/loose_cloth.h"
#include "support/momentum.h"
#include "support/random_state.h"
#include "support/solver_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kNodeContactSpacing_m = 0.01;
const Vector3d kGravity(0, 0, -9.81);
constexpr int kNodeContactIterations = 20;  // the default
constexpr double kNodeContactSpeed_m_per_s = 0.3;
constexpr double kNodeContactForce = 0.01;  // of the weight, as promised
// Of the contact distance. Pairs of the solution keep it, except for the effect of unevenly shared forces, and contacts
// after the solution begin at a thousandth.
constexpr double kSinks = 5e-3;
constexpr double kMomentum = 2e-5;  // of the total: remaining error of 400 sweeps at 5 dt_safe (measured: 4e-6)
constexpr double kEnergy = 0.01;    // of the total, as for leapfrog's contacts
constexpr double kLies = 0.3;       // of a spacing: nodes of one body keep half the distance; those between are lower
constexpr double kRests_m_per_s = 1e-2;

/// Substeps over dt_safe.
constexpr double kFractions[] = {2, 5, 10};

class NodeContact : public OnBackend {
 protected:
  /// A software OpenGL is slow.
  static std::vector<double> fractions() {
    if (GetParam() == "gpu") return {5};
    return {std::begin(kFractions), std::end(kFractions)};
  }
};
INSTANTIATE_TEST_SUITE_P(Backends, NodeContact, ::testing::ValuesIn(backendKinds()), backendSuffix);

Body box(const Vector3i& cells, const Vector3d& origin_m) {
  Body body = boxBody(cells, kNodeContactSpacing_m);
  body.lattice.origin_m = origin_m;
  body.material.mass_damping_per_s = 20;
  return body;
}

/// Returns a box without damping.
Body loose(const Vector3i& cells, const Vector3d& origin_m) {
  Body body = box(cells, origin_m);
  body.material.mass_damping_per_s = body.material.stiffness_damping_ratio = 0;
  return body;
}

ObstacleConfig planeAt(const Vector3d& position_m, const Vector3d& rotation_deg) {
  ObstacleConfig out;
  out.shape = ObstacleShape::kPlane;
  out.position_m = position_m;
  out.rotation_deg = rotation_deg;
  out.friction = 0;
  return out;
}

/// Returns a scene with bodies that may touch each other, on a floor at z = 0.
Scene onAFloor(double fraction, const Model& model, int substeps, std::vector<StylusConfig> styluses = {}) {
  Scene scene =
      sceneWith(Integrator::kPd, model, substeps, fraction, kNodeContactIterations, std::move(styluses), kGravity);
  scene.collision.enabled = true;
  scene.obstacles = {planeAt(Vector3d::Zero(), Vector3d::Zero())};
  return scene;
}

/// Returns the force of an obstacle in the last tick [N].
Vector3d borne(TissueStepper& solver, const Scene& scene, size_t obstacle) {
  return xyz(lastStats(solver).obstacle_impulse[obstacle]) * scene.solver.tick_hz;
}

/// Returns the smallest distance between nodes of two bodies [m].
double nearest(const Model& model, const HostState& state) {
  double least = 1e9;
  forEachNode(model, 0, state, [&](const Vector3d& a, const Vector3d&) {
    forEachNode(model, 1, state, [&](const Vector3d& b, const Vector3d&) { least = std::min(least, (a - b).norm()); });
  });
  return least;
}

double weight(const Model& model, size_t body) {
  ReferenceSolver masses(model, Vector3d::Zero(), 1);
  double sum = 0;
  for (const uint32_t slot : model.bodies[body].lattice.active_slots)
    sum += -kGravity.z() * masses.mass(model.slotOffset(body) + slot);
  return sum;
}

}  // namespace

TEST_P(NodeContact, ABodyBearsTheWeightOfTheOneOnItWhateverTheSubstep) {
  // Nodes of the upper one are above the interior of faces of the lower one.
  const Model model = modelOf(
      {box({2, 2, 1}, {0, 0, 0}),
       box({1, 1, 1}, {0.5 * kNodeContactSpacing_m, 0.4 * kNodeContactSpacing_m, 2.0 * kNodeContactSpacing_m})});
  const double lower_n = weight(model, 0), upper_n = weight(model, 1);
  for (const double fraction : fractions()) {
    SCOPED_TRACE(fraction);
    const Scene scene = onAFloor(fraction, model, 4);
    const auto solver = make(model, scene);
    for (double t = 0; t < 1.0; t += 1 / scene.solver.tick_hz) solver->step({});
    for (int t = 0; t < 5; ++t) {
      solver->step({});
      EXPECT_NEAR(borne(*solver, scene, 0).z() - lower_n, upper_n, kNodeContactForce * upper_n);
    }
    EXPECT_GT(nearest(model, solver->readState()), (1 - kSinks) * kNodeContactSpacing_m);
  }
}

TEST_P(NodeContact, NodesThatTouchObstaclesAndOtherNodesAtOnceBearBoth) {
  // Two boxes on the ground, pulled against a wall: one leans on the other.
  const Model model = modelOf(
      {box({1, 2, 1}, {0, 0, 0}), box({1, 1, 1}, {1.95 * kNodeContactSpacing_m, 0.5 * kNodeContactSpacing_m, 0})});
  const Vector3d gravity(-4, 0, -9.81);
  const double weight_n = weight(model, 0) + weight(model, 1);
  for (const double fraction : fractions()) {
    SCOPED_TRACE(fraction);
    Scene scene = sceneWith(Integrator::kPd, model, 4, fraction, kNodeContactIterations, {}, gravity);
    scene.collision.enabled = true;
    scene.collision.friction = 0;
    scene.obstacles = {planeAt(Vector3d::Zero(), Vector3d::Zero()), planeAt(Vector3d::Zero(), {0, 90, 0})};
    const auto solver = make(model, scene);
    for (double t = 0; t < 1.5; t += 1 / scene.solver.tick_hz) solver->step({});
    const layout::TickStats stats = lastStats(*solver);
    EXPECT_NEAR(stats.obstacle_impulse[0].z * scene.solver.tick_hz, weight_n, kNodeContactForce * weight_n);
    const double pulled_n = weight_n * gravity.x() / gravity.z();
    EXPECT_NEAR(stats.obstacle_impulse[1].x * scene.solver.tick_hz, pulled_n, kNodeContactForce * pulled_n);
    EXPECT_GT(nearest(model, solver->readState()), (1 - kSinks) * kNodeContactSpacing_m);
  }
}

TEST_P(NodeContact, ABoxThatIsPressedOnAnotherByAProbePassesItsForceOn) {
  const Model model = modelOf({box({2, 2, 1}, {0, 0, 0}), box({2, 2, 1}, {0, 0, 2.0 * kNodeContactSpacing_m})});
  const double weight_n = weight(model, 0) + weight(model, 1);
  StylusConfig stylus;
  stylus.probe.radius_m = 3e-3;
  const Vector3d tip(kNodeContactSpacing_m, kNodeContactSpacing_m, 3 * kNodeContactSpacing_m - 1e-3 + 3e-3);
  for (const double fraction : fractions()) {
    SCOPED_TRACE(fraction);
    Scene scene = onAFloor(fraction, model, 4, {stylus});
    scene.obstacles[0].friction = scene.collision.friction = 1;  // or the tip slides off the node below it
    const auto solver = make(model, scene);
    for (double t = 0; t < 0.8; t += 1 / scene.solver.tick_hz) solver->step(probeAt(tip));
    const layout::TickStats stats = lastStats(*solver);
    const double pressed_n = -stats.impulse[0].z * scene.solver.tick_hz;
    const double borne_n = stats.obstacle_impulse[0].z * scene.solver.tick_hz;
    EXPECT_GT(pressed_n, weight_n);
    EXPECT_NEAR(borne_n, weight_n + pressed_n, kNodeContactForce * borne_n);
  }
}

/// Result of a collision of two boxes.
struct Collision {
  double momentum_off = 0;  ///< largest change of the sum of their momenta, over that at the start
  double passed = 0;        ///< momentum that the hit box received, over that at the start
  double energy = 0;        ///< largest energy after the start, over that at the start
};

class NodeCollision : public NodeContact {
 protected:
  Collision collide(double fraction, int iterations, double restitution) const {
    const Model model = modelOf(
        {loose({2, 1, 1}, {0, 0, 0}),
         loose({1, 1, 1}, {0.4 * kNodeContactSpacing_m, 0.3 * kNodeContactSpacing_m, 2.3 * kNodeContactSpacing_m})});
    Scene scene = sceneWith(Integrator::kPd, model, 1, fraction, iterations);
    scene.collision.enabled = true;
    scene.collision.friction = 0.3;
    scene.collision.restitution = restitution;
    HostState state = restState(model);
    place(model, 1, {}, kNodeContactSpeed_m_per_s * Vector3d(0.2, 0, -1), state);
    const Vector3d before = momentum(model, state);
    const double before_j = energyOf(model, state);
    const auto solver = make(model, scene);
    solver->writeState(state);
    Collision out;
    for (double t = 0; t < 0.02 / kNodeContactSpeed_m_per_s; t += 1 / scene.solver.tick_hz) {
      solver->step({});
      state = solver->readState();
      const Vector3d now = momentum(model, state);
      for (const uint32_t slot : model.bodies[1].lattice.active_slots)
        state.velocity_m_per_s[model.slotOffset(1) + slot] = {};
      const Vector3d hit = momentum(model, state);
      out.momentum_off = std::max(out.momentum_off, (now - before).norm() / before.norm());
      out.passed = std::max(out.passed, hit.norm() / before.norm());
      out.energy = std::max(out.energy, energyOf(model, solver->readState()) / before_j);
    }
    return out;
  }
};
INSTANTIATE_TEST_SUITE_P(Backends, NodeCollision, ::testing::ValuesIn(backendKinds()), backendSuffix);

TEST_P(NodeCollision, KeepsMomentum) {
  constexpr int kConverged = 400;
  for (const double fraction : fractions()) {
    if (fraction > 5) continue;  // needs four times the sweeps
    SCOPED_TRACE(fraction);
    const Collision collision = collide(fraction, kConverged, 0.5);
    EXPECT_GT(collision.passed, 0.3);
    EXPECT_LT(collision.momentum_off, kMomentum);
  }
}

TEST_P(NodeCollision, GainsNoEnergyHoweverFewTheSweeps) {
  for (const double restitution : {0.0, 1.0}) {
    for (const double fraction : fractions()) {
      SCOPED_TRACE(::testing::Message() << "dt " << fraction << " restitution " << restitution);
      const Collision collision = collide(fraction, kNodeContactIterations, restitution);
      EXPECT_GT(collision.passed, 0.3);
      EXPECT_LT(collision.energy, 1 + kEnergy);
    }
  }
}

TEST_P(NodeContact, AClothThatFoldsOntoItselfLiesOnItself) {
  const Model model = modelOf({clothBody(4, 9, kNodeContactSpacing_m)});
  HostState start = restState(model);
  std::vector<uint32_t> upper;
  for (const uint32_t slot : model.bodies[0].lattice.active_slots) {
    const Vector3d rest = restPosition(model.bodies[0], slot);
    if (rest.x() <= 0.5 * kNodeContactSpacing_m) continue;
    upper.push_back(slot);
    start.displacement_m[slot] =
        vec4(Vector3d(-2 * rest.x() + 0.0013, 0.0011, std::min(rest.x(), 1.2 * kNodeContactSpacing_m)));
  }
  for (const double fraction : fractions()) {
    SCOPED_TRACE(fraction);
    const Scene scene = onAFloor(fraction, model, 1);
    const auto solver = make(model, scene);
    solver->writeState(start);
    for (double t = 0; t < 0.5; t += 1 / scene.solver.tick_hz) solver->step({});
    const HostState state = solver->readState();
    for (const uint32_t slot : upper) {
      if (restPosition(model.bodies[0], slot).x() < 1.5 * kNodeContactSpacing_m) continue;  // the fold
      EXPECT_GT(positionOf(model, 0, slot, state).z(), kLies * kNodeContactSpacing_m);
      EXPECT_LT(xyz(state.velocity_m_per_s[slot]).norm(), kRests_m_per_s);
    }
  }
}

TEST_P(NodeContact, TheSameSceneGivesTheSameBitsAfterAReset) {
  // They touch from the start on, and one falls towards the other: the last contacts must be cleared.
  Body lower = box({2, 2, 1}, {0, 0, 0});
  for (const uint32_t slot : lower.lattice.active_slots) lower.lattice.nodes[slot].lo |= layout::kFixedBit;
  const Model model = modelOf({lower, box({1, 1, 1}, {0.004, 0.003, 1.8 * kNodeContactSpacing_m})});
  Scene scene = sceneWith(Integrator::kPd, model, 2, 3, kNodeContactIterations, {}, kGravity);
  scene.collision.enabled = true;
  const auto solver = make(model, scene);
  const auto hash = [&] {
    for (int t = 0; t < 40; ++t) solver->step({});
    return stateHash(model, solver->readState());
  };
  const uint64_t first = hash();
  solver->reset();
  EXPECT_EQ(hash(), first);
}
