// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Styluses and the stability monitor on explicit connections (VR05 2.7, physics.md 3, 5).
#include "solver/network_rig.h"
#include "support/solver_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

// Of the position at which a blade crosses a spring: float32 positions of 0.1 m (6e-9 m) over springs of 1 cm, at an
// angle.
constexpr double kFraction = 1e-4;
// A cut is recorded no nearer to an end than this share of the spring (kLeastShare of blade.glsl).
constexpr double kNetworkToolsLeastShare = 0.02;
constexpr int kNetworkToolsSubsteps = 10;

/// Returns a blade along -z that sweeps along y in the plane x = `x_m`.
StylusMotion sweep(double x_m, ToolMode mode = ToolMode::kCut) {
  return motionOf(mode, {x_m, -0.2, 0.1}, {x_m, 0.2, 0.1});
}

/// A cloth of 13 x 13 nodes in z = 0, fixed at its corners.
class ToolsOnNetwork : public BesideReference {
 protected:
  ToolsOnNetwork() : BesideReference(kNetworkToolsSubsteps, wideTools()) {
    Body cloth = clothBody(13, 13, 0.01);
    fixNearest(cloth, {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}});
    use(modelOf({cloth}));
  }
  /// Expects that every spring is whole or cut, and cut at the same position, as in the reference, and the same
  /// valences.
  void expectSameCuts() {
    const HostState state = solver_->readState();
    const std::vector<float>& truth = reference_->spring_cut;
    ASSERT_EQ(state.spring_cut.size(), truth.size());
    for (size_t i = 0; i < truth.size(); ++i) {
      ASSERT_EQ(state.spring_cut[i] == 0, truth[i] == 0) << "spring " << i;
      if (truth[i] == 0) continue;
      const bool erased = truth[i] == layout::kErasedShare;
      const double shown =
          erased ? truth[i] : std::clamp<double>(truth[i], kNetworkToolsLeastShare, 1 - kNetworkToolsLeastShare);
      EXPECT_NEAR(state.spring_cut[i], shown, kFraction) << "spring " << i;
    }
    for (uint32_t slot : reference_->active) {
      EXPECT_EQ(state.nodes[slot].lo & layout::kAxialMask, reference_->nodes[slot].lo & layout::kAxialMask) << slot;
      EXPECT_EQ(state.nodes[slot].hi & layout::kDiagonalMask, reference_->nodes[slot].hi & layout::kDiagonalMask);
    }
    EXPECT_EQ(stats().springs_cut, reference_->springs_cut);
  }
};

INSTANTIATE_TEST_SUITE_P(Backends, ToolsOnNetwork, ::testing::ValuesIn(backendNames()), backendSuffix);

}  // namespace

TEST_P(ToolsOnNetwork, ProbeDentsAndReceivesTheMomentumOfTheReference) {
  ToolMotions motions;
  Vector3d before = Vector3d::Zero();
  for (int t = 0; t < 8; ++t) {
    before = reference_->impulse_n_s[0];
    const double z = 0.015 - 0.001 * t;
    motions[0] = motionOf(ToolMode::kProbe, {0.003, 0.001, z}, {0.003, 0.001, z - 0.001});
    tick(motions);
  }
  expectSameDisplacement();
  const Vector3d truth = reference_->impulse_n_s[0] - before;
  const layout::TickStats s = stats();
  EXPECT_LT((xyz(s.impulse[0]) - truth).norm(), 1e-3 * truth.norm());  // roundings of contact positions
  EXPECT_LT(s.impulse[0].z, 0);                                        // cloth is pushed down
  EXPECT_GT(s.touched[0], 0u);
}

TEST_P(ToolsOnNetwork, ThinProbeBetweenNodesDentsLikeTheReference) {
  styluses_[0].probe.radius_m = 0.003;  // spacing of nodes 10 mm
  use(Model(model_));
  for (int t = 0; t < 8; ++t) {
    const double z = 0.0035 - 0.0004 * t;
    tickWith(motionOf(ToolMode::kProbe, {0.0051, 0.0001, z}, {0.0051, 0.0001, z - 0.0004}));
  }
  expectSameDisplacement();
  const layout::TickStats s = stats();
  EXPECT_LT(s.impulse[0].z, 0);
  EXPECT_GE(s.touched[0], 2u);
}

/// Springs against bending span two others: there is no tissue along them.
TEST_P(ToolsOnNetwork, ProbesDoNotMeetSpringsAgainstBending) {
  styluses_[0].probe.radius_m = 0.003;
  use(modelOf({clothBody(5, 5, 0.01, 0.1)}));
  const auto& springs = body().network->springs;
  const auto spring = std::find_if(springs.begin(), springs.end(), [](const auto& s) { return s.against_bending; });
  ASSERT_NE(spring, springs.end());
  // Between the ends of one, away from which the cloth has been folded.
  const Vector3d a = body().network->positions_m[spring->a], b = body().network->positions_m[spring->b];
  const Vector3d middle = 0.5 * (a + b);
  HostState state = solver_->readState();
  for (const uint32_t slot : lattice().active_slots) {
    if (slot == spring->a || slot == spring->b) continue;
    state.displacement_m[slot].z = -0.008f;
  }
  write(state);
  tickWith(motionOf(ToolMode::kProbe, middle, middle));
  EXPECT_EQ(stats().touched[0], 0u);
}

TEST_P(ToolsOnNetwork, HeldNodesFollowThePoseAndAreLetGoLikeTheReference) {
  ToolMotions motions;
  motions[1] = motionOf(ToolMode::kGrab, {0, 0, 0}, {0, 0, 0.002});
  motions[1].hold_begins = true;
  tick(motions);
  EXPECT_GT(stats().grabbed[1], 3u);
  motions[1] = motionOf(ToolMode::kGrab, {0, 0, 0.002}, {0.002, 0, 0.01});
  motions[1].to.orientation = rotationFromDegrees({10, 20, 90});
  tick(motions);
  expectSameDisplacement();
  motions[1] = motionOf(ToolMode::kNone, motions[1].to.position_m, motions[1].to.position_m);
  motions[1].hold_ended = ToolMode::kGrab;
  tick(motions);
  expectSameDisplacement();
  EXPECT_EQ(stats().grabbed[1], 0u);
}

TEST_P(ToolsOnNetwork, BladeCutsTheSpringsItCrossesFromBothEndsAndNotesWhere) {
  tickWith(sweep(0.0037));
  const HostState state = solver_->readState();
  std::vector<uint32_t> lost(model_.slots(), 0);
  size_t crossing = 0;
  for (size_t i = 0; i < body().network->springs.size(); ++i) {
    const NetworkSpring& spring = body().network->springs[i];
    const double a = restPosition(body(), spring.a).x(), b = restPosition(body(), spring.b).x();
    const bool crosses = (a < 0.0037) != (b < 0.0037);
    EXPECT_EQ(state.spring_cut[i] > 0, crosses) << "spring " << i;
    if (!crosses) continue;
    ++crossing;
    ++lost[spring.a];
    ++lost[spring.b];
    EXPECT_NEAR(state.spring_cut[i],
                std::clamp((0.0037 - a) / (b - a), kNetworkToolsLeastShare, 1 - kNetworkToolsLeastShare), kFraction);
  }
  ASSERT_GT(crossing, 12u);
  for (uint32_t slot : body().lattice.active_slots) {
    const uint32_t whole = body().lattice.nodes[slot].lo & layout::kValenceMask;
    EXPECT_EQ(state.nodes[slot].lo & layout::kValenceMask, whole - lost[slot]);
    EXPECT_EQ((state.nodes[slot].lo & layout::kSeveredBit) != 0, lost[slot] > 0);
  }
  EXPECT_EQ(stats().springs_cut, crossing);
}

/// Where springs move, the sweeps of two substeps have a gap between them unless each is taken relative to its spring.
TEST_P(ToolsOnNetwork, BladeMissesNoSpringThatComesTowardsIt) {
  const double x_m = 0.0013, offset_m = 0.01;  // offset of the blade's plane; displacement of the cloth in a substep,
                                               // in which the blade moves 0.04
  use(modelOf({undamped(clothBody(13, 13, 0.01))}));
  HostState state = restState(model_);
  for (uint32_t slot : reference_->active) state.velocity_m_per_s[slot] = vec4({0, -offset_m / solver_->dt_s(), 0});
  write(state);
  tick({sweep(x_m), {}});
  expectSameCuts();
  const HostState after = solver_->readState();
  const SpringNetwork& network = *body().network;
  for (size_t i = 0; i < network.springs.size(); ++i) {
    const double a = network.positions_m[network.springs[i].a].x() - x_m;
    const double b = network.positions_m[network.springs[i].b].x() - x_m;
    EXPECT_EQ(after.spring_cut[i] != 0, (a > 0) != (b > 0)) << "spring " << i;
  }
}

TEST_P(ToolsOnNetwork, CutAndErasedGraphsLoseWhatTheReferenceLoses) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> angle(-180, 180);
  GraphOptions options;
  options.size_m = 0.06;
  const Model model =
      modelOf({graphBody(300, 900, 3, options), withLinks(boxBody({4, 4, 4}, 0.01)), boxBody({3, 4, 2}, 0.01)});
  for (const ToolMode mode : {ToolMode::kCut, ToolMode::kCutParticles}) {
    use(model);
    size_t cut = 0;
    for (int t = 0; t < 10; ++t) {
      reset();
      ToolMotions motions;
      motions[0] = motionOf(mode, Vector3d::Constant(0.03) + randomVector(random, 0.05),
                            Vector3d::Constant(0.03) + randomVector(random, 0.05));
      motions[0].to.orientation = motions[0].from.orientation =
          rotationFromDegrees({angle(random), angle(random), angle(random)});
      tick(motions);
      expectSameCuts();
      cut += reference_->springs_cut;
    }
    EXPECT_GT(cut, 0u);
  }
}

TEST_P(ToolsOnNetwork, ErasedNodesAreAloneAndRest) {
  tickWith(sweep(0.005, ToolMode::kCutParticles));
  expectSameCuts();
  size_t alone = 0;
  const HostState state = solver_->readState();
  for (uint32_t slot : body().lattice.active_slots) alone += (state.nodes[slot].lo & layout::kValenceMask) == 0;
  EXPECT_GT(alone, 5u);
  HostState moving = state;
  for (uint32_t slot : body().lattice.active_slots) moving.velocity_m_per_s[slot] = {0, 0, 1, 0};
  solver_->writeState(moving);
  solver_->step({});
  const HostState after = solver_->readState();
  for (uint32_t slot : body().lattice.active_slots) {
    if ((state.nodes[slot].lo & layout::kValenceMask) != 0) continue;
    EXPECT_EQ(after.displacement_m[slot].z, state.displacement_m[slot].z) << slot;
  }
}

TEST_P(ToolsOnNetwork, SeveredHalvesExertNoForceOnEachOther) {
  tickWith(sweep(0.0037));
  HostState state = solver_->readState();
  for (uint32_t slot : body().lattice.active_slots) {  // the half beyond the cut moves away by a centimetre
    state.velocity_m_per_s[slot] = {};
    state.displacement_m[slot] = {};
    if (restPosition(body(), slot).x() > 0.0037) state.displacement_m[slot].x = 0.01f;
    state.nodes[slot].lo &= ~layout::kFixedBit;
  }
  Scene scene = sceneFor(model_, 1, styluses_);
  const auto solver = make(model_, scene);
  solver->writeState(state);
  solver->step({});
  const HostState after = solver->readState();
  const double unit = 1e-3 / solver->dt_s();  // an uncut spring would move its ends by millimetres in the substep
  for (uint32_t slot : body().lattice.active_slots) {
    EXPECT_LT(xyz(after.velocity_m_per_s[slot]).norm(), 1e-4 * unit);
  }
}

/// The squared distance is infinite in float32. It must have no effect, not even times zero stiffness.
TEST_P(ToolsOnNetwork, SeveredHalvesDoNotSpoilEachOtherHoweverFarApart) {
  tickWith(sweep(0.0037));
  HostState state = solver_->readState();
  for (uint32_t slot : body().lattice.active_slots) {
    state.nodes[slot].lo &= ~layout::kFixedBit;
    if (restPosition(body(), slot).x() > 0.0037) state.displacement_m[slot].x = 1e25f;
  }
  Scene scene = sceneFor(model_, 1, styluses_);
  const auto solver = make(model_, scene);
  solver->writeState(state);
  solver->step({});
  const HostState after = solver->readState();
  for (uint32_t slot : body().lattice.active_slots) {
    if (restPosition(body(), slot).x() > 0.0037) continue;
    EXPECT_TRUE(xyz(after.velocity_m_per_s[slot]).allFinite()) << slot;
  }
}

TEST_P(ToolsOnNetwork, CutClothMovesLikeTheReference) {
  use(Model(model_));
  ToolMotions motions;
  motions[1] = motionOf(ToolMode::kGrab, {-0.03, 0, 0}, {-0.03, 0, 0.004});
  motions[1].hold_begins = true;
  tick(motions);
  motions[0] = sweep(0.0037);
  motions[0].from.position_m.y() -= 0.003;  // so no substep ends with the blade on a row of nodes
  motions[1] = motionOf(ToolMode::kGrab, {-0.03, 0, 0.004}, {-0.03, 0, 0.01});
  tick(motions);
  expectSameCuts();
  expectSameDisplacement();
}

TEST_P(ToolsOnNetwork, ResetMakesWhatWasCutWholeAgain) {
  const uint64_t whole = stateHash(model_, solver_->readState());
  tickWith(sweep(0.0037));
  EXPECT_NE(stateHash(model_, solver_->readState()), whole);
  solver_->reset();
  EXPECT_EQ(stateHash(model_, solver_->readState()), whole);
  const HostState stretched = scatteredState(model_, 1e-3, 0, 5);
  renewReference();
  write(stretched);
  tick({});
  expectSameDisplacement();
}

TEST_P(ToolsOnNetwork, WrittenStateBringsItsCutsWithIt) {
  HostState state = scatteredState(model_, 1e-3, 0, 5);
  tickWith(sweep(0.0037));
  const HostState cut = solver_->readState();
  state.nodes = cut.nodes;
  state.spring_cut = cut.spring_cut;
  reset();
  write(state);
  tick({});
  expectSameDisplacement();
}

TEST_P(ToolsOnNetwork, BladeAtRestCutsNothing) {
  tickWith(motionOf(ToolMode::kCut, {0.0037, 0, 0.1}, {0.0037, 0, 0.1}));
  EXPECT_EQ(stats().springs_cut, 0u);
}

TEST_P(ToolsOnNetwork, NodesDraggedToNoPlaceAtAllAreRolledBack) {
  Scene scene = sceneFor(model_, kNetworkToolsSubsteps, styluses_);
  scene.solver.stability_monitor = true;
  expectNoPlaceIsRolledBack(*make(model_, scene), model_);
}

TEST_P(ToolsOnNetwork, ExplosionIsRolledBackAndRecoveredFrom) {
  constexpr double kEnergyBound = 1.01;  // of the initial energy, at the end of any tick
  Scene scene = sceneWith(Integrator::kLeapfrog, model_, 10, 10);
  scene.solver.stability_monitor = true;
  SolverOptions unstable;
  unstable.allow_unstable = true;
  const auto solver = make(model_, scene, unstable);
  const HostState start = scatteredState(model_, 3e-3, 0.1, 5);
  const double start_j = energyOf(model_, start);
  solver->writeState(start);
  for (int t = 0; t < 20; ++t) {
    solver->step({});
    const HostState state = solver->readState();
    ASSERT_TRUE(isFinite(state)) << "tick " << t;
    ASSERT_LT(energyOf(model_, state), kEnergyBound * start_j) << "tick " << t;
  }
  EXPECT_GT(solver->health().trips, 0u);
}
