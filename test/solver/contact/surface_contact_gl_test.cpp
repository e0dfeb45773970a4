// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Bodies with partially filled cells are touched at their surface, not at the nodes outside it.
#include "layout/touch_depths.h"
#include "solver/contact/collision.h"
#include "solver/contact/environment.h"
#include "solver/reference/reference_environment.h"
#include "support/backends.h"
#include "support/momentum.h"
#include "support/random_state.h"
#include "tools/motion_packing.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kSurfaceContactSpacing_m = 0.01;
constexpr double kTop_m = 0.5 * 0.0273;          // height of the body's surface
constexpr double kTopNodes_m = kTop_m + 0.0027;  // the last cells are filled to 0.73
constexpr double kPress_m = 1e-3;
constexpr double kPosition_m = 2e-6;  // of a pressed node: displacement of a substep while it settles, and rounding

class SurfaceContact : public OnBackend {};
INSTANTIATE_TEST_SUITE_P(Backends, SurfaceContact, ::testing::ValuesIn(backendKinds()), backendSuffix);

/// Returns a box of 3 x 3 x 2.73 cells, fixed at its lowest nodes.
Model slab() {
  Scene scene;
  BodyConfig config;
  config.source = TissueSource::kBox;
  config.box_size_m = {0.03, 0.03, 0.0273};
  config.spacing_m = kSurfaceContactSpacing_m;
  config.material.mass_damping_per_s = 20;
  FixedConfig bottom;
  bottom.shape = FixedShape::kPlane;
  bottom.point_m = {0, 0, -kTop_m};
  config.fixed = {bottom};
  scene.bodies = {config};
  return buildModel(scene);
}

/// Returns the displacements of the outermost nodes [m].
std::vector<Vector3d> topDisplacements(const Model& model, const HostState& state) {
  std::vector<Vector3d> out;
  const Lattice& lattice = model.bodies[0].lattice;
  for (const uint32_t slot : lattice.active_slots) {
    if (std::abs(lattice.restPosition(slot).z() - kTopNodes_m) < 1e-6) out.push_back(xyz(state.displacement_m[slot]));
  }
  return out;
}

ObstacleConfig lidAt(double z_m) {
  ObstacleConfig lid;
  lid.shape = ObstacleShape::kPlane;
  lid.position_m = {0, 0, z_m};
  lid.rotation_deg = {180, 0, 0};
  lid.friction = 0;
  return lid;
}

ObstacleConfig boxAt(double z_m) {
  ObstacleConfig box;
  box.shape = ObstacleShape::kBox;
  box.size_m = {0.1, 0.1, 0.04};
  box.position_m = {0, 0, z_m + 0.02};
  box.friction = 0;
  return box;
}

}  // namespace

TEST_P(SurfaceContact, ObstaclesMeetTheSurfaceWhereItIs) {
  const Model model = slab();
  for (const bool is_box : {false, true}) {
    SCOPED_TRACE(::testing::Message() << "box " << is_box);
    Scene scene = sceneWith(Integrator::kLeapfrog, model, 4, 0.5);
    const auto obstacleAt = [&](double z_m) { return is_box ? boxAt(z_m) : lidAt(z_m); };
    scene.obstacles = {obstacleAt(kTop_m + 1e-4)};
    auto solver = make(model, scene);
    for (int t = 0; t < 10; ++t) solver->step({});
    for (const Vector3d& u : topDisplacements(model, solver->readState())) EXPECT_EQ(u, Vector3d::Zero().eval());
    scene.obstacles = {obstacleAt(kTop_m - kPress_m)};
    solver = make(model, scene);
    for (double t = 0; t < 0.5; t += 1 / scene.solver.tick_hz) solver->step({});
    const std::vector<Vector3d> pressed = topDisplacements(model, solver->readState());
    EXPECT_EQ(pressed.size(), 16u);
    for (const Vector3d& u : pressed) EXPECT_NEAR(u.z(), -kPress_m, kPosition_m);
  }
}

TEST_P(SurfaceContact, AProbeMeetsTheSurfaceWhereItIs) {
  const Model model = slab();
  constexpr double kRadius_m = 6e-3;
  StylusConfig stylus;
  stylus.probe.radius_m = kRadius_m;
  const Vector3d above(-0.5 * kSurfaceContactSpacing_m, -0.5 * kSurfaceContactSpacing_m,
                       kTop_m + kRadius_m);  // above a node
  const Scene scene = sceneWith(Integrator::kLeapfrog, model, 4, 0.5, 0, {stylus});
  const auto solver = make(model, scene);
  for (int t = 0; t < 10; ++t) solver->step(probeAt(above + Vector3d(0, 0, 1e-4)));
  for (const Vector3d& u : topDisplacements(model, solver->readState())) EXPECT_EQ(u, Vector3d::Zero().eval());
  for (double t = 0; t < 0.5; t += 1 / scene.solver.tick_hz) solver->step(probeAt(above - Vector3d(0, 0, kPress_m)));
  // The node below the tip also yields sideways: its distance is tested.
  const Vector3d tip = above - Vector3d(0, 0, kPress_m), rest(above.x(), above.y(), kTopNodes_m);
  Vector3d lowest = Vector3d::Zero();
  for (const Vector3d& u : topDisplacements(model, solver->readState())) {
    if (u.z() < lowest.z()) lowest = u;
  }
  // Tips also touch the adjacent springs, which hold them off like a cone of their slope.
  const double seen_m = kRadius_m - (kTopNodes_m - kTop_m), away_m = (rest + lowest - tip).norm();
  const double cone_m = 0.02 * seen_m;  // slope 0.2
  EXPECT_GE(away_m, seen_m - kPosition_m);
  EXPECT_LE(away_m, seen_m + cone_m + kPosition_m);
  EXPECT_LT(lowest.z(), -0.9 * kPress_m);
}

TEST_P(SurfaceContact, TheReferenceMeetsItThere) {
  const Model model = slab();
  StylusConfig stylus;
  stylus.probe.radius_m = 6e-3;
  const Vector3d tip(-0.5 * kSurfaceContactSpacing_m, -0.5 * kSurfaceContactSpacing_m, kTop_m + 6e-3 - kPress_m);
  constexpr int kSubsteps = 4, kTicks = 12;
  const Scene scene = sceneWith(Integrator::kLeapfrog, model, kSubsteps, 0.5, 0, {stylus});
  const auto solver = make(model, scene);
  ReferenceOptions options;
  options.push_speed_m_per_s = pushSpeed(model);
  ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()), options);
  for (int t = 0; t < kTicks; ++t) {
    solver->step(probeAt(tip));
    std::vector<layout::ToolMotion> rows;
    interpolateMotions(probeAt(tip), {stylus}, kSubsteps, rows);
    for (size_t s = 0; s < kSubsteps; ++s) reference.substep({rows[2 * s], rows[2 * s + 1]});
  }
  constexpr double kFloat = 1e-4;  // of the displacements, after some ten substeps of contact
  EXPECT_LT(relativeError(solver->readState().displacement_m, reference.u_m, reference.active), kFloat);
}

namespace {

/// Returns a slab of so many cells, fixed below, and another one upside down above it, `gap_m` between their surfaces.
Scene twoSlabs(double cells, double gap_m) {
  const double height_m = cells * kSurfaceContactSpacing_m;
  Scene scene;
  BodyConfig lower;
  lower.source = TissueSource::kBox;
  lower.box_size_m = {0.03, 0.03, height_m};
  lower.spacing_m = kSurfaceContactSpacing_m;
  lower.material.mass_damping_per_s = 20;
  BodyConfig upper = lower;
  FixedConfig bottom;
  bottom.shape = FixedShape::kPlane;
  bottom.point_m = {0, 0, -0.5 * height_m};
  lower.fixed = {bottom};
  upper.position_m = {0, 0, height_m + gap_m};
  upper.rotation_deg = {180, 0, 0};
  scene.bodies = {lower, upper};
  scene.bodies[0].name = "lower";
  scene.bodies[1].name = "upper";
  return scene;
}

/// Returns the distance between the surfaces of two bodies, from their touching nodes [m].
double betweenSurfaces(const Model& model, const HostState& state) {
  const std::vector<float> depths_m = touchDepths(model, {});
  ReferenceSolver reference(model, Vector3d::Zero(), 1);
  load(reference, state);
  double out = 1;
  for (const uint32_t a : reference.active) {
    for (const uint32_t b : reference.active) {
      if (a >= model.slotOffset(1) || b < model.slotOffset(1)) continue;
      if (std::max(std::abs(depths_m[a]), std::abs(depths_m[b])) >= layout::kTouchesOnceCut) continue;
      const Vector3d apart =
          reference.restPosition(a) + reference.u_m[a] - reference.restPosition(b) - reference.u_m[b];
      out = std::min(out, apart.norm() - depths_m[a] - depths_m[b]);
    }
  }
  return out;
}

double farthestMoved(const HostState& state) {
  double out = 0;
  for (const layout::vec4& u : state.displacement_m) out = std::max(out, xyz(u).norm());
  return out;
}

}  // namespace

TEST_P(SurfaceContact, BodiesTouchWhereTheirSurfacesAre) {
  constexpr double kNear_m = kSurfaceContactSpacing_m;  // distance at which surfaces of such lattices touch
  constexpr double kApart_m = 1e-4;                     // remaining distance in the given time
  for (const double cells : {2.05, 2.52}) {  // touching nodes are just below the surface, and half a cell deep
    SCOPED_TRACE(::testing::Message() << "cells " << cells);
    for (const double gap_m : {kNear_m + 1e-4, kNear_m - 1e-3}) {
      const double seconds = gap_m > kNear_m ? 0.05 : 0.3;  // what does not move initially never does
      const Model model = buildModel(twoSlabs(cells, gap_m));
      Scene scene = sceneWith(Integrator::kLeapfrog, model, 4, 0.5);
      scene.collision.enabled = true;
      scene.collision.friction = 0;
      const auto solver = make(model, scene);
      EXPECT_NEAR(betweenSurfaces(model, solver->readState()), gap_m, 1e-6);
      for (double t = 0; t < seconds; t += 1 / scene.solver.tick_hz) solver->step({});
      const HostState state = solver->readState();
      if (gap_m > kNear_m) {
        EXPECT_EQ(farthestMoved(state), 0);
      } else {
        EXPECT_GT(farthestMoved(state), 5e-4);
        EXPECT_GT(betweenSurfaces(model, state), kNear_m - kApart_m);
      }
    }
  }
}

TEST_P(SurfaceContact, TheReferenceHasThemTouchThere) {
  const Model model = buildModel(twoSlabs(2.52, kSurfaceContactSpacing_m - 1e-3));
  Scene scene = sceneWith(Integrator::kLeapfrog, model, 1, 0.5);
  scene.collision.enabled = true;
  const auto solver = make(model, scene);
  ReferenceOptions options;
  options.push_speed_m_per_s = pushSpeed(model);
  options.environment = std::make_shared<ReferenceEnvironment>(model, scene);
  ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()), options);
  const HostState bent = randomState(model, 2e-4, 0.05, 9);
  HostState start = solver->readState();
  start.displacement_m = bent.displacement_m;
  start.velocity_m_per_s = bent.velocity_m_per_s;
  for (size_t slot = 0; slot < start.nodes.size(); ++slot) {
    if (isFixed(start.nodes[slot])) start.velocity_m_per_s[slot] = {};
  }
  solver->writeState(start);
  load(reference, start);
  for (int t = 0; t < 6; ++t) {
    solver->step({});
    reference.substep();
  }
  constexpr double kRounded = 1e-4;  // of the displacements, after six substeps of contact in float32
  EXPECT_LT(relativeError(solver->readState().displacement_m, reference.u_m, reference.active), kRounded);
}

namespace {

/// Returns a ball and another one that moves towards it. Nothing else acts on them, and only their contact may
/// dissipate energy.
Scene twoBalls() {
  Scene scene;
  BodyConfig ball;
  ball.source = TissueSource::kBall;
  ball.ball_radius_m = 0.024;
  ball.spacing_m = kSurfaceContactSpacing_m;
  ball.material.mass_damping_per_s = ball.material.stiffness_damping_ratio = 0;
  scene.bodies = {ball, ball};
  scene.bodies[0].name = "still";
  scene.bodies[1].name = "thrown";
  scene.bodies[1].position_m = {0.064, 0.013, 0.007};
  return scene;
}

/// Returns the mean velocity, weighted by mass [m/s].
Vector3d meanVelocity(const Model& model, const HostState& state, size_t body) {
  ReferenceSolver reference(model, Vector3d::Zero(), 1);
  Vector3d sum = Vector3d::Zero();
  double mass_kg = 0;
  for (const uint32_t local : model.bodies[body].lattice.active_slots) {
    const uint32_t slot = model.slotOffset(body) + local;
    sum += reference.mass(slot) * xyz(state.velocity_m_per_s[slot]);
    mass_kg += reference.mass(slot);
  }
  return sum / mass_kg;
}

}  // namespace

// If a surface point that moves with neighbours makes contact, and only its node is pushed, energy is created: balls in
// a cloth never came to rest. If the velocity from a substep's own forces bounces too, a ball gains half as much again.
TEST_P(SurfaceContact, BallsThatBounceKeepTheirMomentumAndGainNoEnergy) {
  constexpr double kSpeed_m_per_s = 0.5;
  constexpr double kRounded = 1e-5;   // of the total: float32 in some hundred substeps
  constexpr double kHalfStep = 0.03;  // of the total: during contact, as velocities are half a substep earlier
  constexpr double kGains = 1e-3;     // of the total, afterwards: pushing nodes apart adds no velocity, but deforms
  const Model model = buildModel(twoBalls());
  for (const double restitution : {0.0, 1.0}) {
    SCOPED_TRACE(::testing::Message() << "restitution " << restitution);
    Scene scene = sceneWith(Integrator::kLeapfrog, model, 4, 0.5);
    scene.collision.enabled = true;
    scene.collision.friction = 0;
    scene.collision.restitution = restitution;
    const auto solver = make(model, scene);
    HostState start = solver->readState();
    for (const uint32_t slot : model.bodies[1].lattice.active_slots) {
      start.velocity_m_per_s[model.slotOffset(1) + slot].x = -kSpeed_m_per_s;
    }
    solver->writeState(start);
    const Vector3d momentum_n_s = momentum(model, start);
    const double energy_j = energyOf(model, start);
    HostState state;
    for (int t = 1; t <= 120; ++t) {
      solver->step({});
      if (t % 10 != 0) continue;
      state = solver->readState();
      EXPECT_LT((momentum(model, state) - momentum_n_s).norm(), kRounded * momentum_n_s.norm());
      EXPECT_LT(energyOf(model, state), (1 + kHalfStep) * energy_j);
    }
    EXPECT_LT(energyOf(model, state), (1 + kGains) * energy_j);
    EXPECT_LT(meanVelocity(model, state, 0).x(), -0.3 * kSpeed_m_per_s) << "they have not met";
    EXPECT_GT(meanVelocity(model, state, 0).x(), -kSpeed_m_per_s);
  }
}
