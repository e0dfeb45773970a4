// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/solver_rig.h"
#include "viscera/tools/tools.h"

using namespace viscera;
using namespace viscera::test;

namespace {

class ToolsOnTissue : public BesideReference {
 protected:
  ToolsOnTissue() : BesideReference(20, wideTools()) {
    Body body = boxBody({6, 6, 6}, 0.01);
    for (uint32_t slot : body.lattice.active_slots) {
      if (body.lattice.nodeAt(slot).z() == 0) body.lattice.nodes[slot].lo |= layout::kFixedBit;
    }
    use(modelOf({body}));
  }
};

size_t asymmetricSprings(const Lattice& lattice, const std::vector<layout::NodeBits>& nodes) {
  size_t wrong = 0;
  for (uint32_t slot : lattice.active_slots) {
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      const int64_t other = lattice.neighborSlot(slot, s);
      const uint32_t here = springCount(nodes[slot], s);
      wrong += here != (other < 0 ? 0 : springCount(nodes[static_cast<size_t>(other)], oppositeSpring(s)));
    }
  }
  return wrong;
}

INSTANTIATE_TEST_SUITE_P(Backends, ToolsOnTissue, ::testing::ValuesIn(backendNames()), backendSuffix);

}  // namespace

TEST_P(ToolsOnTissue, ProbeDentsLikeTheReference) {
  ToolMotions motions;
  for (int t = 0; t < 10; ++t) {
    const double z = 0.075 - 0.002 * t;
    motions[0] = motionOf(ToolMode::kProbe, {0.031, 0.029, z}, {0.031, 0.029, z - 0.002});
    tick(motions);
  }
  expectSameDisplacement();
  float lowest = 0;
  for (const layout::vec4& u : solver_->readState().displacement_m) lowest = std::min(lowest, u.z);
  EXPECT_LT(lowest, -0.004);
}

/// A tip of 0.4 spacings in the middle between four nodes, and next to it, that touches no node.
TEST_P(ToolsOnTissue, ThinProbeBetweenNodesDentsLikeTheReference) {
  styluses_[0].probe.radius_m = 0.004;
  for (const Vector3d& at : {Vector3d(0.035, 0.035, 0), Vector3d(0.035, 0.03, 0), Vector3d(0.0342, 0.0331, 0)}) {
    use(Model(model_));
    Vector3d before = Vector3d::Zero();
    for (int t = 0; t < 10; ++t) {
      before = reference_->impulse_n_s[0];
      const Vector3d from = at + Vector3d(0, 0, 0.0655 - 0.0004 * t);
      tickWith(motionOf(ToolMode::kProbe, from, from - Vector3d(0, 0, 0.0004)));
    }
    expectSameDisplacement();
    const Vector3d truth = reference_->impulse_n_s[0] - before;
    const layout::TickStats s = stats();
    EXPECT_LT((xyz(s.impulse[0]) - truth).norm(), 1e-3 * truth.norm());  // as below
    EXPECT_LT(truth.z(), 0);
    EXPECT_GE(s.touched[0], at.y() == 0.03 ? 2u : 3u);
  }
}

TEST_P(ToolsOnTissue, ReactionIsTheMomentumGivenPerTick) {
  ToolMotions motions;
  Vector3d before = Vector3d::Zero();
  for (int t = 0; t < 10; ++t) {
    before = reference_->impulse_n_s[0];
    const double z = 0.075 - 0.001 * t;
    motions[0] = motionOf(ToolMode::kProbe, {0.03, 0.03, z}, {0.03, 0.03, z - 0.001});
    tick(motions);
  }
  const Vector3d truth = reference_->impulse_n_s[0] - before;
  const layout::TickStats s = stats();
  EXPECT_LT((xyz(s.impulse[0]) - truth).norm(),
            1e-3 * truth.norm());  // roundings of contact positions, as in expectSameDisplacement()
  EXPECT_LT(s.impulse[0].z, 0);    // tissue is pushed down
  EXPECT_GT(s.touched[0], 0u);
  EXPECT_EQ(xyz(s.impulse[1]), Vector3d::Zero().eval());
}

TEST_P(ToolsOnTissue, ProbeThatJumpsLeavesNoNodeInsideIt) {
  Tools tools(styluses_, {waveSpeed(model_) * tick_s()});
  StylusSamples samples;
  samples[0].valid = true;
  samples[0].pose.position_m = Vector3d(0.03, 0.03, 0.12);
  tools.advance(samples);
  samples[0].pose.position_m = Vector3d(0.03, 0.03, 0.02);  // 10 cm in one tick: several hundred times c_p
  ToolMotions motions;
  do {
    motions = tools.advance(samples);
    tick(motions);
  } while (motions[0].speed_limited);
  const HostState state = solver_->readState();
  for (uint32_t slot : lattice().active_slots) {
    const Vector3d x = lattice().restPosition(slot) + xyz(state.displacement_m[slot]);
    EXPECT_TRUE(x.allFinite());
    if (isFixed(lattice().nodes[slot])) continue;
    EXPECT_GT((x - motions[0].to.position_m).norm(), 0.99 * styluses_[0].probe.radius_m);
  }
}

TEST_P(ToolsOnTissue, ProbeThatAppearsInsideTissuePushesNoFasterThanItsPushSpeed) {
  tickWith(motionOf(ToolMode::kProbe, {0.031, 0.032, 0.033}, {0.031, 0.032, 0.033}));
  const double farthest = pushSpeed(model_) * tick_s();
  double moved = 0;
  for (const layout::vec4& u : solver_->readState().displacement_m) moved = std::max(moved, xyz(u).norm());
  EXPECT_GT(moved, 0);
  EXPECT_LT(moved, 1.001 * farthest);  // float32 rounding of a sum of ten steps
}

TEST_P(ToolsOnTissue, ProbeAtANodesPositionHasADirectionAllTheSame) {
  ToolMotions motions;
  const Vector3d node(0.03, 0.03, 0.06);
  tickWith(motionOf(ToolMode::kProbe, node, node));
  for (const layout::vec4& u : solver_->readState().displacement_m) EXPECT_TRUE(xyz(u).allFinite());
  EXPECT_GT(stats().touched[0], 0u);
}

TEST_P(ToolsOnTissue, SecondToolTakesNeitherWhatTheFirstHoldsNorWhatIsFixed) {
  ToolMotions motions;
  const Vector3d low(0.03, 0.03, 0.005);  // among fixed nodes (z = 0) and free ones
  for (uint32_t s = 0; s < 2; ++s) {
    motions[s] = motionOf(ToolMode::kGrab, low, low);
    motions[s].hold_begins = true;
  }
  tick(motions);
  const layout::TickStats held = stats();
  EXPECT_GT(held.grabbed[0], 0u);
  EXPECT_EQ(held.grabbed[1], 0u);
  const HostState state = solver_->readState();
  for (uint32_t slot : lattice().active_slots) {
    const bool held_and_fixed = isFixed(state.nodes[slot]) && (state.nodes[slot].lo & layout::kGrabMask) != 0u;
    EXPECT_FALSE(held_and_fixed) << slot;
  }
}

TEST_P(ToolsOnTissue, HeldNodesFollowTheFullPose) {
  ToolMotions motions;
  motions[1] = motionOf(ToolMode::kGrab, {0.03, 0.03, 0.06}, {0.03, 0.03, 0.062});
  motions[1].hold_begins = true;
  tick(motions);
  const layout::TickStats held = stats();
  EXPECT_GT(held.grabbed[1], 0u);
  motions[1] = motionOf(ToolMode::kGrab, {0.03, 0.03, 0.062}, {0.032, 0.03, 0.07});
  motions[1].to.orientation = rotationFromDegrees({10, 20, 90});
  tick(motions);
  expectSameDisplacement();
  const HostState state = solver_->readState();
  const Pose grabbed{{0.03, 0.03, 0.06}, Quaterniond::Identity()};
  for (uint32_t slot : lattice().active_slots) {
    const Vector3d rest = lattice().restPosition(slot);
    if ((rest - grabbed.position_m).norm() > 0.0119) continue;
    const Vector3d where = motions[1].to * (grabbed.inverse() * rest);
    EXPECT_LT((rest + xyz(state.displacement_m[slot]) - where).norm(), 1e-7);  // m, float32 at 0.1 m
  }
}

TEST_P(ToolsOnTissue, ReleaseClampsTheVelocity) {
  ToolMotions motions;
  motions[0] = motionOf(ToolMode::kGrab, {0.03, 0.03, 0.06}, {0.03, 0.03, 0.08});
  motions[0].hold_begins = true;
  tick(motions);
  motions[0] = motionOf(ToolMode::kNone, {0.03, 0.03, 0.08}, {0.03, 0.03, 0.08});
  motions[0].hold_ended = ToolMode::kGrab;
  tick(motions);
  expectSameDisplacement();
  EXPECT_EQ(stats().grabbed[0], 0u);
}

TEST_P(ToolsOnTissue, BladeCutsTheSpringsItCrossesFromBothEnds) {
  // The blade points along -z from z = 0.16 to -0.04 and sweeps along x in the plane y = 0.035, between two rows of
  // nodes.
  tickWith(motionOf(ToolMode::kCut, {-0.02, 0.035, 0.16}, {0.08, 0.035, 0.16}));
  const HostState state = solver_->readState();
  EXPECT_EQ(asymmetricSprings(lattice(), state.nodes), 0u);
  size_t crossing = 0;
  for (uint32_t slot : lattice().active_slots) {
    const int y = lattice().nodeAt(slot).y();
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      if (!springCount(lattice().nodes[slot], s)) continue;
      const bool crosses = y == 3 && kNeighborOffsets[s][1] == 1;
      const bool crosses_back = y == 4 && kNeighborOffsets[s][1] == -1;
      crossing += crosses ? 1 : 0;
      EXPECT_EQ(springCount(state.nodes[slot], s) == 0, crosses || crosses_back);
    }
  }
  EXPECT_EQ(stats().springs_cut, crossing);
}

TEST_P(ToolsOnTissue, MasksStaySymmetricAndLikeTheReferenceAfterRandomCuts) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-180, 180);
  ToolMotions motions;
  for (int t = 0; t < 60; ++t) {
    for (uint32_t s = 0; s < 2; ++s) {
      const Vector3d middle = Vector3d::Constant(0.03);
      motions[s] = motionOf(t % 7 == 6 ? ToolMode::kCutParticles : ToolMode::kCut, middle + randomVector(random, 0.08),
                            middle + randomVector(random, 0.08));
      motions[s].from.orientation = rotationFromDegrees({angle(random), angle(random), angle(random)});
      motions[s].to.orientation = rotationFromDegrees({angle(random), angle(random), angle(random)});
    }
    const HostState before = solver_->readState();
    load(*reference_, before);  // each round starts from the same state: cuts must agree, not the chaos after many
    tick(motions);
    ASSERT_EQ(asymmetricSprings(lattice(), solver_->readState().nodes), 0u) << "after cut " << t;
  }
  EXPECT_GT(stats().springs_cut, 0u);
}

TEST_P(ToolsOnTissue, OneSweepCutsWhatTheReferenceCuts) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> angle(-180, 180);
  for (ToolMode mode : {ToolMode::kCut, ToolMode::kCutParticles}) {
    for (int t = 0; t < 10; ++t) {
      reset();
      ToolMotions motions;
      motions[0] = motionOf(mode, Vector3d(0.03, 0.03, 0.05) + randomVector(random, 0.05),
                            Vector3d(0.03, 0.03, 0.05) + randomVector(random, 0.05));
      motions[0].to.orientation = motions[0].from.orientation =
          rotationFromDegrees({angle(random), angle(random), angle(random)});
      tick(motions);
      const HostState state = solver_->readState();
      size_t different = 0;
      for (uint32_t slot : lattice().active_slots) {
        different += (state.nodes[slot].lo ^ reference_->nodes[slot].lo) & layout::kAxialMask ? 1 : 0;
        different += (state.nodes[slot].hi ^ reference_->nodes[slot].hi) & layout::kDiagonalMask ? 1 : 0;
      }
      EXPECT_EQ(different, 0u);
    }
  }
}

TEST_P(ToolsOnTissue, ParticleEraseLeavesAWiderGapThanSpringErase) {
  ToolMotions motions;
  const auto isolated = [&] {
    size_t count = 0;
    const HostState state = solver_->readState();
    for (uint32_t slot : lattice().active_slots) {
      const layout::NodeBits bits = state.nodes[slot];
      count += (bits.lo & layout::kAxialMask) == 0 && (bits.hi & layout::kDiagonalMask) == 0;
    }
    return count;
  };
  motions[0] = motionOf(ToolMode::kCut, {-0.02, 0.031, 0.16}, {0.08, 0.031, 0.16});
  tick(motions);
  EXPECT_EQ(isolated(), 0u);  // springs only: no node is lost, the gap is one rest length
  solver_->reset();
  motions[0].mode = ToolMode::kCutParticles;
  tick(motions);
  EXPECT_EQ(isolated(), 49u);  // the 7 x 7 nodes of the plane y = 0.03: the gap is two rest lengths
}

TEST_P(ToolsOnTissue, BladeAtRestCutsNothing) {
  tickWith(motionOf(ToolMode::kCut, {0.03, 0.035, 0.16}, {0.03, 0.035, 0.16}));
  EXPECT_EQ(stats().springs_cut, 0u);
}

TEST_P(ToolsOnTissue, SeveredSpringExertsNoForce) {
  tickWith(motionOf(ToolMode::kCut, {-0.02, 0.035, 0.16}, {0.08, 0.035, 0.16}));
  HostState state = solver_->readState();
  for (uint32_t slot : lattice().active_slots) {  // the half beyond the cut moves away by a centimetre
    state.velocity_m_per_s[slot] = {};
    state.displacement_m[slot] = {};
    if (lattice().nodeAt(slot).y() >= 4) state.displacement_m[slot].y = 0.01f;
    state.nodes[slot].lo &= ~layout::kFixedBit;
  }
  solver_->writeState(state);
  solver_->step({});
  const HostState after = solver_->readState();
  for (uint32_t slot : lattice().active_slots) {
    // m/s: rounding of displacements of 1 cm, times k/m dt; an uncut spring would give about 5 m/s
    EXPECT_LT(xyz(after.velocity_m_per_s[slot]).norm(), 1e-3);
  }
}

TEST_P(ToolsOnTissue, NonFiniteNodesAreCounted) {
  HostState state = solver_->readState();
  state.displacement_m[lattice().active_slots[200]].x = std::numeric_limits<float>::quiet_NaN();
  solver_->writeState(state);
  solver_->step({});
  EXPECT_GT(stats().nonfinite, 0u);
}
