// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Bodies with partially filled cells are cut and held at their tissue, not at the nodes outside it.
#include "math/decompositions.h"
#include "support/random_state.h"
#include "support/solver_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kSurfaceToolsSpacing_m = 0.01;
constexpr double kSurfaceToolsTop_m = 0.5 * 0.0273;  // height of the surface; nodes above it are 2.7 mm higher
constexpr double kSurfaceToolsBlade_m = 0.2;

class SurfaceTools : public OnBackend {};
INSTANTIATE_TEST_SUITE_P(Backends, SurfaceTools, ::testing::ValuesIn(backendKinds()), backendSuffix);

StylusConfig surfaceToolsStylusConfig() {
  StylusConfig config;
  config.cut.blade_length_m = kSurfaceToolsBlade_m;
  config.cut.blade_side = BladeSide::kAhead;
  config.cut_particles.eraser_radius_m = 0.001;
  return config;
}

BodyConfig boxConfig(const Vector3d& size_m) {
  BodyConfig config;
  config.source = TissueSource::kBox;
  config.box_size_m = size_m;
  config.spacing_m = kSurfaceToolsSpacing_m;
  return config;
}

/// Returns a box of 3 x 3 x 2.73 cells about the origin.
Model slab() {
  Scene scene;
  scene.bodies = {boxConfig({0.03, 0.03, 0.0273})};
  return buildModel(scene);
}

/// Returns the state in which the whole body is turned about the origin, at rest.
HostState turnedState(const Model& model, const Eigen::Matrix3d& turn) {
  const Lattice& lattice = model.bodies[0].lattice;
  HostState state;
  state.displacement_m.resize(model.slots());
  state.velocity_m_per_s.resize(model.slots());
  for (const uint32_t slot : lattice.active_slots) {
    const Vector3d rest = lattice.restPosition(slot), u = turn * rest - rest;
    state.displacement_m[slot] = {static_cast<float>(u.x()), static_cast<float>(u.y()), static_cast<float>(u.z()), 0};
  }
  return state;
}

/// Returns one sweep from `from` to `to`, with the blade along `along`, all turned with the body.
ToolMotions sweep(const Eigen::Matrix3d& turn, const Vector3d& from, const Vector3d& to, const Vector3d& along) {
  ToolMotions out = tool(ToolMode::kCut, turn * from, turn * to);
  out[0].from.orientation = out[0].to.orientation = rotationBetween(-Vector3d::UnitZ(), turn * along);
  return out;
}

/// Springs that a sweep cuts in a tick of one substep.
struct Cuts {
  uint32_t backend, reference;
};

Cuts cutsOf(const Model& model, const std::unique_ptr<TissueStepper>& solver, const HostState& state,
            const ToolMotions& motions) {
  solver->reset();
  HostState start = solver->readState();
  start.displacement_m = state.displacement_m;
  start.velocity_m_per_s = state.velocity_m_per_s;
  solver->writeState(start);
  ReferenceSolver reference(model, Vector3d::Zero(), static_cast<float>(solver->dt_s()));
  load(reference, start);
  tickBoth(*solver, reference, {surfaceToolsStylusConfig()}, 1, motions);
  return {lastStats(*solver).springs_cut, static_cast<uint32_t>(reference.springs_cut)};
}

/// Returns the number of springs between nodes with rest positions y below and above 0.
uint32_t springsAcross(const Model& model) {
  const Lattice& lattice = model.bodies[0].lattice;
  uint32_t out = 0;
  for (const uint32_t slot : lattice.active_slots) {
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      if (!springCount(lattice.nodes[slot], s) || lattice.restPosition(slot).y() > 0) continue;
      out += lattice.restPosition(static_cast<uint32_t>(lattice.neighborSlot(slot, s))).y() > 0 ? 1 : 0;
    }
  }
  return out;
}

const Eigen::Matrix3d kTurns[] = {Eigen::Matrix3d::Identity(),
                                  Eigen::AngleAxisd(0.9, Vector3d(1, 2, -0.5).normalized()).toRotationMatrix()};

}  // namespace

TEST_P(SurfaceTools, ABladeThatBeginsAtTheSurfaceCutsAllThereIs) {
  const Model model = slab();
  const auto solver = make(model, sceneWith(Integrator::kLeapfrog, model, 1, 0.1, 0, {surfaceToolsStylusConfig()}));
  for (const Eigen::Matrix3d& turn : kTurns) {
    const Vector3d down = -Vector3d::UnitZ(), up(0, 0, kSurfaceToolsTop_m + 2e-4);
    const Cuts cuts = cutsOf(model, solver, turnedState(model, turn),
                             sweep(turn, up - 0.1 * Vector3d::UnitX(), up + 0.1 * Vector3d::UnitX(), down));
    EXPECT_EQ(cuts.backend, springsAcross(model));
    EXPECT_EQ(cuts.reference, springsAcross(model));
  }
}

TEST_P(SurfaceTools, ABladeInTheAirCutsNothing) {
  const Model model = slab();
  const auto solver = make(model, sceneWith(Integrator::kLeapfrog, model, 1, 0.1, 0, {surfaceToolsStylusConfig()}));
  for (const Eigen::Matrix3d& turn : kTurns) {
    for (const double height_m : {2e-4, 2e-3}) {  // both below the nodes
      const Vector3d from(-0.1, -0.1, kSurfaceToolsTop_m + height_m), to(0.1, -0.1, kSurfaceToolsTop_m + height_m);
      const Cuts cuts = cutsOf(model, solver, turnedState(model, turn), sweep(turn, from, to, Vector3d::UnitY()));
      EXPECT_EQ(cuts.backend, 0u);
      EXPECT_EQ(cuts.reference, 0u);
    }
    const Vector3d from(-0.1, -0.1, kSurfaceToolsTop_m - 2e-4), to(0.1, -0.1, kSurfaceToolsTop_m - 2e-4);
    const Cuts cuts = cutsOf(model, solver, turnedState(model, turn), sweep(turn, from, to, Vector3d::UnitY()));
    EXPECT_GT(cuts.backend, 0u);
    EXPECT_EQ(cuts.backend, cuts.reference);
  }
}

TEST_P(SurfaceTools, RandomSweepsCutAsTheReferenceDoes) {
  constexpr double kRounded = 0.02;  // of the springs: displacements to the surface are stored to 1/256 of a cell
  Scene scene;
  scene.bodies = {boxConfig({0.052, 0.043, 0.037})};
  scene.bodies[0].rotation_deg = {20, 35, 10};
  const Model model = buildModel(scene);
  const auto solver = make(model, sceneWith(Integrator::kLeapfrog, model, 1, 0.1, 0, {surfaceToolsStylusConfig()}));
  std::mt19937 random(3);
  uint32_t all = 0, different = 0;
  for (int t = 0; t < 20; ++t) {
    const HostState bent = randomState(model, 1e-3, 0, 100 + static_cast<uint32_t>(t));
    const Cuts cuts = cutsOf(model, solver, bent,
                             sweep(Eigen::Matrix3d::Identity(), randomVector(random, 0.06), randomVector(random, 0.06),
                                   randomVector(random, 1).normalized()));
    all += cuts.reference;
    different += static_cast<uint32_t>(std::abs(static_cast<int>(cuts.backend) - static_cast<int>(cuts.reference)));
  }
  EXPECT_GT(all, 500u);
  EXPECT_LE(different, kRounded * all);
}

TEST_P(SurfaceTools, AGripHoldsTheTissueThatItReaches) {
  const Model model = slab();
  StylusConfig stylus = surfaceToolsStylusConfig();
  stylus.grab.radius_m = 2e-3;
  const auto solver = make(model, sceneWith(Integrator::kLeapfrog, model, 1, 0.1, 0, {stylus}));
  const auto heldAt = [&](double z_m) {
    const Vector3d tip(-0.5 * kSurfaceToolsSpacing_m, -0.5 * kSurfaceToolsSpacing_m, z_m);
    ToolMotions motions = tool(ToolMode::kGrab, tip, tip);
    motions[0].hold_begins = true;
    solver->reset();
    solver->step(motions);
    uint32_t held = 0;
    for (const layout::NodeBits& bits : solver->readState().nodes) held += (bits.lo & layout::kGrabMask) != 0 ? 1 : 0;
    return held;
  };
  EXPECT_EQ(heldAt(kSurfaceToolsTop_m + 2.7e-3), 0u) << "at the node, in the air";
  EXPECT_EQ(heldAt(kSurfaceToolsTop_m + 1e-3), 1u);
  EXPECT_EQ(heldAt(kSurfaceToolsTop_m - 1e-3), 1u);
}
