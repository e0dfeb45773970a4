// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Tests that would detect a return of the papers' errors (docs/papers.md) where no other test would.
#include <limits>

#include "support/solver_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kSpacing_m = 1.0 / 128;  // a power of two: every rest position is exact in float32

class PaperErrors : public GpuTest {
 protected:
  static Model block(const Vector3i& cells) { return modelOf({boxBody(cells, kSpacing_m)}); }
  static uint32_t slotAt(const Model& model, const Vector3i& node) {
    return static_cast<uint32_t>(model.bodies[0].lattice.slotAt(node));
  }
  /// Makes one tick with the first stylus.
  static void tick(GpuSolver& solver, const StylusMotion& stylus) { solver.step(ToolMotions{stylus}); }
};

/// Returns a scene of the papers' own integrator, in which probes touch nodes only.
Scene probeScene(const Model& model, double radius_m) {
  StylusConfig config;
  config.probe.radius_m = radius_m;
  Scene scene = sceneFor(model, 1, {config});
  scene.solver.integrator = Integrator::kVerletPaper;
  return scene;
}

StylusConfig thinProbe(double radius_m) {
  StylusConfig config;
  config.probe.radius_m = radius_m;
  return config;
}

}  // namespace

TEST_F(PaperErrors, ProbeThatPassesANodeWithinASubstepMovesItAside) {
  constexpr double kRadius_m = 0.1 * kSpacing_m;
  const Model model = block({4, 4, 4});
  GpuSolver solver(model, probeScene(model, kRadius_m));
  const uint32_t slot = slotAt(model, {2, 2, 4});
  const Vector3d node = model.bodies[0].lattice.restPosition(slot);
  const Vector3d beside = node + Vector3d(0.5 * kRadius_m, 0, 0), halfway(0, 0, 5 * kRadius_m);
  tick(solver, motionOf(ToolMode::kProbe, beside + halfway, beside - halfway));
  // At either end the sphere is five radii away; in between, its axis passes the node at half a radius.
  const Vector3d x = node + xyz(solver.readState().displacement_m[slot]);
  EXPECT_NEAR(x.x(), beside.x() - kRadius_m, 1e-8);  // m: a few roundings of positions below 0.03 m
  EXPECT_NEAR(x.z(), node.z(), 1e-8);                // sideways, not along
}

TEST_F(PaperErrors, ProbeWithANodeExactlyAtItsCentrePushesItUpwards) {
  const Model model = block({4, 4, 4});
  GpuSolver solver(model, probeScene(model, 0.1 * kSpacing_m));
  const uint32_t slot = slotAt(model, {2, 2, 4});
  const Vector3d node = model.bodies[0].lattice.restPosition(slot);
  tick(solver, motionOf(ToolMode::kProbe, node, node));
  const Vector3d u = xyz(solver.readState().displacement_m[slot]);
  EXPECT_LT((u - Vector3d(0, 0, 0.1 * kSpacing_m)).norm(), 1e-8);  // m: a few roundings of positions below 0.03 m
}

/// A probe at rest that appears around a node moves it, but without velocity: the probe did not move towards it.
TEST_F(PaperErrors, NodeThatAProbeMovesOutTakesTheSpeedOfTheToolAlone) {
  constexpr double kRadius_m = 0.1 * kSpacing_m;
  const Model model = block({4, 4, 4});
  GpuSolver solver(model, probeScene(model, kRadius_m));
  const uint32_t slot = slotAt(model, {2, 2, 4});
  const Vector3d below = model.bodies[0].lattice.restPosition(slot) - Vector3d(0, 0, 0.5 * kRadius_m);
  tick(solver, motionOf(ToolMode::kProbe, below, below));
  const HostState state = solver.readState();
  EXPECT_NEAR(xyz(state.displacement_m[slot]).z(), 0.5 * kRadius_m, 1e-8);  // m: roundings as above
  EXPECT_EQ(xyz(state.velocity_m_per_s[slot]), Vector3d::Zero().eval());    // at rest, like the tool
}

/// Projected to the surface at once, nodes would jump by a whole radius in a substep.
TEST_F(PaperErrors, ProbeThatAppearsDeepInTissueMovesNodesOutNoFasterThanItsPushSpeed) {
  const Model model = block({6, 6, 6});
  GpuSolver solver(model, sceneFor(model, 1, {thinProbe(3 * kSpacing_m)}));
  const Vector3d middle = model.bodies[0].lattice.restPosition(slotAt(model, {3, 3, 3}));
  tick(solver, motionOf(ToolMode::kProbe, middle, middle));
  double farthest_m = 0;
  for (const layout::vec4& u : solver.readState().displacement_m) farthest_m = std::max(farthest_m, xyz(u).norm());
  const double push_m = pushSpeed(model) * solver.dt_s();
  ASSERT_LT(push_m, 2 * kSpacing_m);
  EXPECT_NEAR(farthest_m, push_m, 1e-8);  // m: a few roundings of positions below 0.05 m
}

TEST_F(PaperErrors, CutsTakeSpringsAndNoMassSoTheStableSubstepNeverShrinks) {
  const Model model = block({5, 5, 5});
  const Lattice& lattice = model.bodies[0].lattice;
  StylusConfig config;
  config.cut.blade_length_m = 0.2;
  config.cut.blade_side = BladeSide::kAhead;
  config.cut_particles.eraser_radius_m = 0.6 * kSpacing_m;
  for (const ToolMode mode : {ToolMode::kCut, ToolMode::kCutParticles}) {
    GpuSolver solver(model, sceneFor(model, 4, {config}));
    solver.step({});
    const uint32_t rate_whole = lastStats(solver).max_rate_bits;  // positive floats order like their bits
    const double y = 2.5 * kSpacing_m;
    tick(solver, motionOf(mode, {-0.02, y, 0.1}, {0.08, y, 0.1}));
    const layout::TickStats cut = lastStats(solver);
    EXPECT_GT(cut.springs_cut, 0u);
    EXPECT_LE(cut.max_rate_bits, rate_whole);
    const HostState state = solver.readState();
    for (uint32_t slot : lattice.active_slots) {
      ASSERT_EQ(massEighths(state.nodes[slot]), massEighths(lattice.nodes[slot])) << "slot " << slot;
    }
  }
}

TEST_F(PaperErrors, InfinitiesAreCountedAsNotFiniteLikeNan) {
  const Model model = block({2, 2, 2});
  const uint32_t middle = slotAt(model, {1, 1, 1});
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {infinity, -infinity, std::numeric_limits<float>::quiet_NaN()}) {
    GpuSolver solver(model, sceneFor(model, 1));
    HostState state = restState(model);
    for (uint32_t slot : model.bodies[0].lattice.active_slots) state.nodes[slot].lo |= layout::kFixedBit;
    state.displacement_m[middle].x = bad;
    solver.writeState(state);
    solver.step({});
    EXPECT_EQ(lastStats(solver).nonfinite, 1u) << bad;  // nothing moves, so no other check detects it
  }
}

TEST_F(PaperErrors, FragmentsThatFallAreStoppedWhereSleepDistanceEnds) {
  constexpr double kSleep_m = 0.05, kGravity = 9.81;
  const Model model = block({1, 1, 1});  // nothing holds it
  Scene scene = sceneFor(model, 20, {}, Vector3d(0, 0, -kGravity));
  scene.solver.sleep_distance_m = kSleep_m;
  GpuSolver solver(model, scene);
  const double tick_s = 20 * solver.dt_s(), fall_s = std::sqrt(2 * kSleep_m / kGravity);
  for (double t = 0; t < 3 * fall_s; t += tick_s) solver.step({});  // a free fall would be nine times as deep
  const HostState state = solver.readState();
  for (uint32_t slot : model.bodies[0].lattice.active_slots) {
    EXPECT_LE(xyz(state.displacement_m[slot]).norm(), kSleep_m);
    EXPECT_GT(xyz(state.displacement_m[slot]).norm(), 0.9 * kSleep_m);  // stopped there, not before
  }
}

/// Free fall in numbers that float32 represents exactly. dt^2 a is a quarter of an ulp of u, and is lost whenever it is
/// added to u alone. The total displacement in substep n is (n - 1/2)/4 ulps: roundings cancel every fourth substep.
TEST_F(PaperErrors, IncrementsAreSummedBeforeTheyAreAddedToTheDisplacement) {
  constexpr int kTicks = 8, kSubsteps = 128;
  constexpr double kDt_s = 1.0 / 8192, kGravity = 2, kStart_m = 1.25, kDigit_m = 1.0 / (1 << 23);
  Model model = block({1, 1, 1});
  model.bodies[0].material.mass_damping_per_s = 0;
  Scene scene = sceneFor(model, kSubsteps, {}, Vector3d(kGravity, 0, 0));
  scene.solver.tick_hz = 1 / (kSubsteps * kDt_s);
  scene.solver.substeps = kSubsteps;
  GpuSolver solver(model, scene);
  ASSERT_EQ(solver.dt_s(), kDt_s);
  ASSERT_GE(kDt_s, kShortSubstep_s);  // not compensated
  HostState state = restState(model);
  for (uint32_t slot : model.bodies[0].lattice.active_slots) state.displacement_m[slot].x = kStart_m;
  solver.writeState(state);
  for (int t = 0; t < kTicks; ++t) solver.step({});
  const double n = kTicks * kSubsteps, fallen_m = 0.5 * n * n * kDt_s * kDt_s * kGravity;
  for (uint32_t slot : model.bodies[0].lattice.active_slots) {
    EXPECT_NEAR(solver.readState().displacement_m[slot].x, kStart_m + fallen_m, kDigit_m);
  }
}
