// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact/environment.h"
#include "support/backends.h"
#include "support/loose_cloth.h"
#include "support/text.h"
#include "viscera/math/error.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kEnvironmentSpacing_m = 0.01;
const Vector3d kEnvironmentGravity(0, 0, -9.81);
constexpr double kDegree = 3.14159265358979323846 / 180;

ObstacleConfig obstacle(ObstacleShape shape, const Vector3d& position_m = Vector3d::Zero()) {
  ObstacleConfig out;
  out.shape = shape;
  out.position_m = position_m;
  out.friction = 0;
  return out;
}

/// Returns a flat plate, its top at z = 0.
ObstacleConfig plate(double thickness_m) {
  ObstacleConfig out = obstacle(ObstacleShape::kBox, Vector3d(0, 0, -0.5 * thickness_m));
  out.size_m = Vector3d(1, 1, thickness_m);
  return out;
}

class Surround : public OnBackend {
 protected:
  /// Makes the solver and its state. @param substeps  per tick
  void begin(const Model& model, const Scene& scene, const HostState& state) {
    solver_ = make(model, scene);
    solver_->writeState(state);
    obstacles_ = Obstacles(scene.obstacles);
  }
  HostState after(double time_s, int substeps = 1) {
    const double tick_s = solver_->dt_s() * substeps;
    for (int t = 0; t < std::lround(time_s / tick_s); ++t) {
      obstacles_.advance(t * tick_s, tick_s);
      solver_->step({}, obstacles_.motions());
    }
    return solver_->readState();
  }
  std::unique_ptr<TissueStepper> solver_;
  Obstacles obstacles_{{}};
};

INSTANTIATE_TEST_SUITE_P(Backends, Surround, ::testing::ValuesIn(backendKinds()), backendSuffix);

double highest(const Model& model, const HostState& state) {
  double out = -1e9;
  forEachNode(model, 0, state, [&](const Vector3d& x, const Vector3d&) { out = std::max(out, x.z()); });
  return out;
}
double lowest(const Model& model, const HostState& state) {
  double out = 1e9;
  forEachNode(model, 0, state, [&](const Vector3d& x, const Vector3d&) { out = std::min(out, x.z()); });
  return out;
}
Vector3d meanVelocity(const Model& model, const HostState& state) {
  Vector3d sum = Vector3d::Zero();
  forEachNode(model, 0, state, [&](const Vector3d&, const Vector3d& v) { sum += v; });
  return sum / static_cast<double>(model.bodies[0].lattice.active_slots.size());
}
/// Returns the largest distance of a node from its position under a pose [m].
double farthest(const Model& model, const HostState& state, const Pose& pose) {
  double out = 0;
  const Body& body = model.bodies[0];
  for (const uint32_t slot : body.lattice.active_slots) {
    out = std::max(out, (positionOf(model, 0, slot, state) - pose * restPosition(body, slot)).norm());
  }
  return out;
}

}  // namespace

TEST_P(Surround, AClothThatBouncesComesBackToTheSquareOfItsRestitution) {
  const Model model = modelOf({looseCloth(4, 4, kEnvironmentSpacing_m)});
  constexpr double kHeight_m = 0.05;
  for (const double restitution : {1.0, 0.6}) {
    Scene scene = sceneFor(model, 8, {}, kEnvironmentGravity);
    scene.obstacles = {obstacle(ObstacleShape::kPlane)};
    scene.obstacles[0].restitution = restitution;
    HostState state = restState(model);
    place(model, 0, {Vector3d(0, 0, kHeight_m), Quaterniond::Identity()}, Vector3d::Zero(), state);
    begin(model, scene, state);
    const double fall_s = std::sqrt(2 * kHeight_m / 9.81);
    after(fall_s * (1 + restitution), 8);
    const double top_m = highest(model, solver_->readState());
    // The bounce may be up to a substep late: it loses the displacement of one substep at the speed of impact.
    const double late_m = 9.81 * fall_s * solver_->dt_s() * 2;
    EXPECT_NEAR(top_m, restitution * restitution * kHeight_m, late_m);
  }
}

TEST_P(Surround, ABodyStaysOnASlopeIfAndOnlyIfItsTangentIsBelowTheFriction) {
  constexpr double kFriction = 0.5, kTime_s = 0.2;
  for (const double tangent : {0.48, 0.52}) {
    SCOPED_TRACE(tangent);
    const Model model = modelOf({looseCloth(4, 4, kEnvironmentSpacing_m)});
    Scene scene = sceneFor(model, 8, {}, kEnvironmentGravity);
    const double angle = std::atan(tangent);
    scene.obstacles = {obstacle(ObstacleShape::kPlane)};
    scene.obstacles[0].rotation_deg = Vector3d(0, angle / kDegree, 0);
    scene.obstacles[0].friction = kFriction;
    const Pose lying{Vector3d::Zero(), rotationFromDegrees(scene.obstacles[0].rotation_deg)};
    HostState state = restState(model);
    place(model, 0, lying, Vector3d::Zero(), state);
    begin(model, scene, state);
    const HostState end = after(kTime_s, 8);
    const double slides = 9.81 * std::max(0.0, std::sin(angle) - kFriction * std::cos(angle));  // m/s2
    const Vector3d down = lying.orientation * Vector3d::UnitX();
    // Of rounding at 1 m/s2 and more: a resting body may creep by at most a micrometre.
    EXPECT_NEAR(meanVelocity(model, end).dot(down), slides * kTime_s, 1e-2 * slides * kTime_s + 1e-5);
    const double offset_m = 0.5 * slides * kTime_s * kTime_s;
    EXPECT_NEAR(farthest(model, end, lying), offset_m, 1e-2 * offset_m + 1e-6);
  }
}

TEST_P(Surround, ABlockOfTissueStaysOnASlopeToo) {
  Body body = boxBody({3, 3, 2}, kEnvironmentSpacing_m);
  const Model model = modelOf({body});
  Scene scene = sceneFor(model, 8, {}, kEnvironmentGravity);
  scene.obstacles = {obstacle(ObstacleShape::kPlane)};
  scene.obstacles[0].rotation_deg = Vector3d(0, 20, 0);
  const Pose lying{Vector3d::Zero(), rotationFromDegrees(scene.obstacles[0].rotation_deg)};
  for (const double friction : {0.6, 0.2}) {
    scene.obstacles[0].friction = friction;
    HostState state = restState(model);
    place(model, 0, lying, Vector3d::Zero(), state);
    begin(model, scene, state);
    const double moved_m = farthest(model, after(0.3, 8), lying);
    if (friction > std::tan(20 * kDegree)) {
      EXPECT_LT(moved_m, 0.1 * kEnvironmentSpacing_m);  // it settles under its weight
    } else {
      EXPECT_GT(moved_m, kEnvironmentSpacing_m);
    }
  }
}

TEST_P(Surround, NothingPassesAThinPlateHoweverFast) {
  const Model model = modelOf({looseCloth(5, 5, kEnvironmentSpacing_m)});
  for (const double plate_speed : {0.0, 5.0}) {
    for (const double offsets : {0.5, 3.0, 40.0}) {  // of the plate's thickness per substep
      SCOPED_TRACE(offsets);
      constexpr double kThickness_m = 1e-3;
      Scene scene = sceneFor(model, 1);
      scene.obstacles = {plate(kThickness_m)};
      scene.obstacles[0].velocity_m_per_s = Vector3d(0, 0, plate_speed);
      const double dt_s = 1 / scene.solver.tick_hz, speed = offsets * kThickness_m / dt_s;
      HostState state = restState(model);
      const Pose above{Vector3d(0, 0, 0.3 * offsets * kThickness_m), rotationFromDegrees({0.01, 0.02, 0})};
      place(model, 0, above, Vector3d(0.2 * speed, 0, -speed), state);
      begin(model, scene, state);
      double top_m = 0;
      for (int s = 0; s < 5; ++s) {
        obstacles_.advance(s * solver_->dt_s(), solver_->dt_s());
        solver_->step({}, obstacles_.motions());
        top_m += plate_speed * solver_->dt_s();
        EXPECT_GT(lowest(model, solver_->readState()), top_m - 1e-6);
      }
    }
  }
}

TEST_P(Surround, FastNodesStopWhereTheyEnterSpheresAndCapsules) {
  const Model model = modelOf({looseCloth(7, 7, kEnvironmentSpacing_m)});
  constexpr double kRadius_m = 0.02;
  for (const ObstacleShape shape : {ObstacleShape::kSphere, ObstacleShape::kCapsule}) {
    Scene scene = sceneFor(model, 1);
    scene.obstacles = {obstacle(shape)};
    scene.obstacles[0].radius_m = kRadius_m;
    scene.obstacles[0].rotation_deg = Vector3d(90, 0, 0);  // the capsule along y
    const double dt_s = 1 / scene.solver.tick_hz;
    HostState state = restState(model);
    place(model, 0, {Vector3d(0.001, 0.0005, 0.04), Quaterniond::Identity()}, Vector3d(0, 0, -0.08 / dt_s), state);
    begin(model, scene, state);
    solver_->step({});
    const HostState end = solver_->readState();
    forEachNode(model, 0, end, [&](const Vector3d& x, const Vector3d& v) {
      const double across = shape == ObstacleShape::kSphere ? std::hypot(x.x(), x.y()) : std::abs(x.x());
      if (across > 1.001 * kRadius_m) {
        EXPECT_LT(v.z(), -1);  // passed by
      } else if (across < 0.99 * kRadius_m) {
        EXPECT_NEAR(x.z(), std::sqrt(kRadius_m * kRadius_m - across * across), 1e-5);
        const Vector3d normal = Vector3d(x.x(), shape == ObstacleShape::kSphere ? x.y() : 0, x.z()).normalized();
        EXPECT_GT(v.dot(normal), -1e-3 * 0.08 / dt_s);
      }
    });
  }
}

TEST_P(Surround, MovingPlatesCarryAndPush) {
  const Model model = modelOf({looseCloth(4, 4, kEnvironmentSpacing_m)});
  Scene scene = sceneFor(model, 8, {}, kEnvironmentGravity);
  scene.obstacles = {plate(0.01)};
  scene.obstacles[0].friction = 0.5;
  scene.obstacles[0].velocity_m_per_s = Vector3d(0.2, 0, 0.1);
  begin(model, scene, restState(model));
  const HostState end = after(0.3, 8);
  EXPECT_LT((meanVelocity(model, end) - scene.obstacles[0].velocity_m_per_s).norm(), 1e-3);
  EXPECT_NEAR(lowest(model, end), 0.1 * 0.3, 1e-4);  // a tick more or less
}

TEST_P(Surround, AFrameThatAppearsIsNoMotionAndOneThatMovesPushesEvenly) {
  const Model model = modelOf({looseCloth(4, 4, kEnvironmentSpacing_m)});
  constexpr int kSubsteps = 16;
  Scene scene = sceneFor(model, kSubsteps);
  scene.obstacles = {plate(0.01)};
  scene.obstacles[0].frame = "lift";
  begin(model, scene, restState(model));
  Obstacles obstacles(scene.obstacles);
  const double tick_s = kSubsteps * solver_->dt_s();
  obstacles.setFrame(0, {Vector3d(0, 0, -0.05), Quaterniond::Identity()});
  obstacles.advance(0, tick_s);
  solver_->step({}, obstacles.motions());
  EXPECT_EQ(highest(model, solver_->readState()), 0);
  obstacles.setFrame(0, {Vector3d(0, 0, 0.002), Quaterniond::Identity()});
  obstacles.advance(tick_s, tick_s);
  solver_->step({}, obstacles.motions());
  const HostState end = solver_->readState();
  EXPECT_NEAR(lowest(model, end), 0.002, 1e-6);
  EXPECT_NEAR(meanVelocity(model, end).z(), 0.052 / (kSubsteps * solver_->dt_s()), 1e-3);
}

TEST_P(Surround, WhatAnObstacleAppearsAroundLeavesItNoFasterThanAProbePushes) {
  const Model model = modelOf({looseCloth(5, 5, kEnvironmentSpacing_m)});
  Scene scene = sceneFor(model, 1);
  scene.obstacles = {obstacle(ObstacleShape::kSphere, Vector3d(0, 0, 0.005))};
  scene.obstacles[0].radius_m = 0.05;
  begin(model, scene, restState(model));
  solver_->step({});
  const HostState end = solver_->readState();
  const double most_m = pushSpeed(model) * solver_->dt_s();
  double largest_m = 0;
  for (const uint32_t slot : model.bodies[0].lattice.active_slots) {
    largest_m = std::max(largest_m, xyz(end.displacement_m[slot]).norm());
  }
  EXPECT_GT(largest_m, 0.5 * most_m);
  EXPECT_LT(largest_m, 1.001 * most_m);
  EXPECT_EQ(meanVelocity(model, end).norm(), 0);
}

TEST_P(Surround, FixedNodesAndLoneNodesAreLeftAlone) {
  Body cloth = looseCloth(4, 4, kEnvironmentSpacing_m);
  const uint32_t fixed = fixNearest(cloth, {Vector3d::Zero()})[0];
  cloth.force_n = Vector3d(0, 0, 1);
  const Model model = modelOf({cloth});
  Scene scene = sceneFor(model, 4);
  scene.obstacles = {obstacle(ObstacleShape::kPlane, Vector3d(0, 0, 0.01))};
  HostState state = restState(model);
  const uint32_t lone = model.bodies[0].lattice.active_slots[0];
  state.nodes[lone].lo &= ~layout::kValenceMask;
  begin(model, scene, state);
  solver_->step({});
  const HostState end = solver_->readState();
  EXPECT_EQ(xyz(end.displacement_m[fixed]), Vector3d::Zero());
  EXPECT_EQ(xyz(end.displacement_m[lone]), Vector3d::Zero());
}

TEST_P(Surround, AForceGivesItsBodyForceOverMass) {
  Body pushed = looseCloth(5, 6, kEnvironmentSpacing_m), other = looseCloth(5, 6, kEnvironmentSpacing_m);
  pushed.force_n = Vector3d(0.01, -0.02, 0.03);
  const Model model = modelOf({pushed, other});
  begin(model, sceneFor(model, 8), restState(model));
  const HostState end = after(0.02, 8);
  double mass = 0;
  for (const double m : pushed.network->masses_kg) mass += m;
  const double time_s = solver_->dt_s() * static_cast<double>(solver_->substepsDone());
  const Vector3d expected = pushed.force_n / mass * time_s;
  EXPECT_LT((meanVelocity(model, end) - expected).norm(), 1e-4 * expected.norm());
  forEachNode(model, 1, end, [](const Vector3d&, const Vector3d& v) { EXPECT_EQ(v, Vector3d::Zero()); });
}

/// dv/dt = rho C/2 (w - v)^2 / (surface density), the same for every node: area and mass are both shares of triangles.
TEST_P(Surround, WindBlowsAClothAwayAsTheEquationSays) {
  const Model model = modelOf({looseCloth(6, 6, kEnvironmentSpacing_m)});
  Scene scene = sceneFor(model, 8);
  scene.environment.wind.velocity_m_per_s = Vector3d(3, 0, 8);  // wind along the cloth has no effect
  scene.environment.wind.drag_coefficient = 1.5;
  begin(model, scene, restState(model));
  const HostState end = after(0.1, 8);
  const double time_s = solver_->dt_s() * static_cast<double>(solver_->substepsDone());
  const double surface_density = 1000 * 1e-3, rate = 0.5 * 1.2 * 1.5 / surface_density;
  const double expected = 8 - 8 / (1 + 8 * rate * time_s);
  forEachNode(model, 0, end, [&](const Vector3d&, const Vector3d& v) {
    EXPECT_NEAR(v.z(), expected, 1e-3 * expected);  // explicit: first order in 8 rate dt
    EXPECT_NEAR(v.x(), 0, 1e-4);
  });
}

TEST_P(Surround, NoWindHoweverDenseThrowsAClothFasterThanItself) {
  const Model model = modelOf({looseCloth(6, 6, kEnvironmentSpacing_m)});
  Scene scene = sceneFor(model, 8);
  scene.environment.wind.velocity_m_per_s = Vector3d(0, 0, 2);
  scene.environment.wind.air_density_kg_per_m3 = 2000;
  scene.environment.wind.drag_coefficient = 10;
  begin(model, scene, restState(model));
  for (int t = 0; t < 20; ++t) {
    solver_->step({});
    EXPECT_LT(meanVelocity(model, solver_->readState()).z(), 2.001);
  }
  EXPECT_GT(meanVelocity(model, solver_->readState()).z(), 1.9);
}

TEST_P(Surround, GustsSwingTheWindByTheirShare) {
  const Model model = modelOf({looseCloth(3, 3, kEnvironmentSpacing_m)});
  Scene scene = sceneFor(model, 8);
  WindConfig& wind = scene.environment.wind;
  wind.velocity_m_per_s = Vector3d(0, 0, 4);
  wind.gust_ratio = 0.5;
  wind.gust_period_s = 0.4;
  Environment environment(model, scene);
  environment.beginTick(0.1, 1, {});
  EXPECT_NEAR(environment.at(0).wind_m_per_s.z(), 4 * (1 + 0.5 * std::sin(45 * kDegree)), 1e-5);
  environment.beginTick(0.1, 1, {});
  environment.beginTick(0.1, 1, {});
  EXPECT_NEAR(environment.at(0).wind_m_per_s.z(), 4 * (1 - 0.5 * std::sin(45 * kDegree)), 1e-5);
  environment.reset();
  environment.beginTick(0.2, 2, {});
  EXPECT_NEAR(environment.at(1).wind_m_per_s.z(), 4 * (1 + 0.5 * std::sin(135 * kDegree)), 1e-5);
}

TEST_P(Surround, ATornTriangleCatchesNoWind) {
  const Model model = modelOf({looseCloth(3, 3, kEnvironmentSpacing_m)});
  Scene scene = sceneFor(model, 1);
  scene.environment.wind.velocity_m_per_s = Vector3d(0, 0, 4);
  HostState state = restState(model);
  for (float& cut : state.spring_cut) cut = 0.5f;
  const uint32_t kept = model.bodies[0].lattice.active_slots[0];  // one link left, so that the node is not isolated
  for (layout::NodeBits& bits : state.nodes) bits.lo |= layout::kSeveredBit;
  begin(model, scene, state);
  solver_->step({});
  EXPECT_EQ(xyz(solver_->readState().velocity_m_per_s[kept]), Vector3d::Zero());
}

TEST_P(Surround, PdMeetsObstaclesToo) {
  const Model model = modelOf({looseCloth(4, 4, kEnvironmentSpacing_m)});
  Scene scene = sceneFor(model, 4, {}, kEnvironmentGravity);
  scene.solver.integrator = Integrator::kPd;
  scene.obstacles = {obstacle(ObstacleShape::kPlane, Vector3d(0, 0, -0.001))};
  begin(model, scene, restState(model));
  const HostState end = after(0.05, 4);
  EXPECT_NEAR(lowest(model, end), -0.001, 1e-6);
  EXPECT_NEAR(meanVelocity(model, end).z(), 0, 1e-2);
}
