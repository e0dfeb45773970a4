// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Bodies whose cells are tissue in part are touched at their surface, not at the nodes outside of it.
#include "solver/surroundings.h"
#include "support/backends.h"
#include "support/random_state.h"
#include "tools/motion_packing.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kSpacing_m = 0.01;
constexpr double kTop_m = 0.5 * 0.0273;          // of the body's surface
constexpr double kTopNodes_m = kTop_m + 0.0027;  // the last cells are tissue to 0.73
constexpr double kPress_m = 1e-3;
constexpr double kPlace_m = 2e-6;  // of a node that is pressed: a substep's way of what settles, and float rounding
constexpr Integrator kSteppers[] = {Integrator::kLeapfrog, Integrator::kVbd, Integrator::kPd};

class SurfaceContact : public OnBackend {};
INSTANTIATE_TEST_SUITE_P(Backends, SurfaceContact, ::testing::ValuesIn(backendKinds()), backendSuffix);

/// A box of 3 x 3 x 2.73 cells, held at its lowest nodes.
Model slab() {
  Scene scene;
  BodyConfig config;
  config.source = TissueSource::kBox;
  config.box_size_m = {0.03, 0.03, 0.0273};
  config.spacing_m = kSpacing_m;
  config.material.cells = Cells::kMoments;
  config.material.drag_per_s = 20;
  FixedConfig bottom;
  bottom.shape = FixedShape::kPlane;
  bottom.point_m = {0, 0, -kTop_m};
  config.fixed = {bottom};
  scene.bodies = {config};
  return buildModel(scene);
}

/// Displacements of the outermost nodes [m].
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
  for (const Integrator integrator : kSteppers) {
    for (const bool is_box : {false, true}) {
      SCOPED_TRACE(::testing::Message() << "integrator " << static_cast<int>(integrator) << " box " << is_box);
      const double fraction = integrator == Integrator::kLeapfrog ? 0.5 : 3;
      Scene scene = sceneWith(integrator, model, 4, fraction, 60);
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
      for (const Vector3d& u : pressed) EXPECT_NEAR(u.z(), -kPress_m, kPlace_m);
    }
  }
}

TEST_P(SurfaceContact, AProbeMeetsTheSurfaceWhereItIs) {
  const Model model = slab();
  constexpr double kRadius_m = 6e-3;
  StylusConfig stylus;
  stylus.probe.radius_m = kRadius_m;
  const Vector3d above(-0.5 * kSpacing_m, -0.5 * kSpacing_m, kTop_m + kRadius_m);  // above a node
  for (const Integrator integrator : kSteppers) {
    SCOPED_TRACE(::testing::Message() << "integrator " << static_cast<int>(integrator));
    const double fraction = integrator == Integrator::kLeapfrog ? 0.5 : 3;
    const Scene scene = sceneWith(integrator, model, 4, fraction, 60, {stylus});
    const auto solver = make(model, scene);
    for (int t = 0; t < 10; ++t) solver->step(probeAt(above + Vector3d(0, 0, 1e-4)));
    for (const Vector3d& u : topDisplacements(model, solver->readState())) EXPECT_EQ(u, Vector3d::Zero().eval());
    for (double t = 0; t < 0.5; t += 1 / scene.solver.tick_hz) solver->step(probeAt(above - Vector3d(0, 0, kPress_m)));
    // The node below the tip gives way sideways too: what holds is its distance.
    const Vector3d tip = above - Vector3d(0, 0, kPress_m), rest(above.x(), above.y(), kTopNodes_m);
    Vector3d lowest = Vector3d::Zero();
    for (const Vector3d& u : topDisplacements(model, solver->readState())) {
      if (u.z() < lowest.z()) lowest = u;
    }
    EXPECT_NEAR((rest + lowest - tip).norm(), kRadius_m - (kTopNodes_m - kTop_m), kPlace_m);
    EXPECT_LT(lowest.z(), -0.9 * kPress_m);
  }
}

TEST_P(SurfaceContact, TheReferenceMeetsItThere) {
  const Model model = slab();
  StylusConfig stylus;
  stylus.probe.radius_m = 6e-3;
  const Vector3d tip(-0.5 * kSpacing_m, -0.5 * kSpacing_m, kTop_m + 6e-3 - kPress_m);
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
