// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Blades and lattices that move at the same time: a cut follows the blade's path relative to the springs, and nodes
// keep the side on which the blade met them.
#include "support/random_state.h"
#include "support/solver_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kMovingCutsSpacing_m = 0.01;
// Of the position of a cut on a spring: float32 positions of 0.1 m (6e-9 m) over springs of 1 cm, at an angle, after
// some substeps.
constexpr double kShare = 1e-4;

/// Returns a blade along -z over the body's whole height.
StylusMotion blade(const Vector3d& from, const Vector3d& to) {
  return motionOf(ToolMode::kCut, from, to);
}

class MovingCuts : public BesideReference {
 protected:
  MovingCuts() : BesideReference(20, wideTools()) { use(modelOf({freeBox()})); }
  static Body freeBox() {
    Body body = boxBody({6, 6, 6}, kMovingCutsSpacing_m);
    body.material.mass_damping_per_s = body.material.stiffness_damping_ratio = 0;
    return body;
  }
  /// Returns a state in which the whole body moves by that displacement in a tick, without forces.
  HostState drifting(const Vector3d& offset_m) const {
    HostState state = restState(model_);
    for (const uint32_t slot : lattice().active_slots) state.velocity_m_per_s[slot] = vec4(offset_m / tick_s());
    return state;
  }
  /// Expects that both ends of every spring agree with each other and with the reference, and that the positions of
  /// cuts do.
  void expectLikeTheReference() const {
    const HostState state = solver_->readState();
    for (const uint32_t slot : lattice().active_slots) {
      for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
        const int64_t far = lattice().neighborSlot(slot, s);
        if (far < 0) continue;
        const uint32_t count = springCount(state.nodes[slot], s);
        ASSERT_EQ(count, springCount(state.nodes[static_cast<size_t>(far)], oppositeSpring(s))) << slot << ", " << s;
        ASSERT_EQ(count, springCount(reference_->nodes[slot], s)) << slot << ", " << s;
      }
    }
    for (size_t i = 0; i < state.axial_cut.size(); ++i) {
      ASSERT_NEAR(state.axial_cut[i], reference_->axial_cut[i], kShare) << i;
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Backends, MovingCuts, ::testing::ValuesIn(backendNames()), backendSuffix);

}  // namespace

/// The sweeps of two substeps have a gap between them unless each is taken relative to its spring.
TEST_P(MovingCuts, BladeMissesNoSpringThatComesTowardsIt) {
  const double x_m = 0.0137;
  write(drifting({0, -0.1, 0}));  // half a spacing in a substep
  tick({blade({x_m, -0.2, 0.16}, {x_m, 0.2, 0.16}), {}});
  expectLikeTheReference();
  const HostState state = solver_->readState();
  for (const uint32_t slot : lattice().active_slots) {
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      if (springCount(lattice().nodes[slot], s) == 0) continue;
      const bool crosses = lattice().nodeAt(slot).x() == 1 && kNeighborOffsets[s][0] == 1;
      const bool crosses_back = lattice().nodeAt(slot).x() == 2 && kNeighborOffsets[s][0] == -1;
      EXPECT_EQ(springCount(state.nodes[slot], s) == 0, crosses || crosses_back) << slot << ", spring " << s;
    }
  }
}

/// A blade cuts only along its path.
TEST_P(MovingCuts, TissueThatSwaysAgainstABladeAtRestStaysWhole) {
  const Vector3d tip(0.0137, 0.0251, 0.16);
  write(drifting({0.006, 0.006, 0}));
  tick({blade(tip, tip), {}});
  expectLikeTheReference();
  EXPECT_EQ(reference_->springs_cut, 0u);
}

/// A layer of nodes moves across the blade's path while the blade moves along it: each loses springs on one side.
TEST_P(MovingCuts, NodesKeepTheSideOnWhichTheBladeMetThem) {
  write(drifting({0.001, 0, 0}));  // the layer at 0.02 is in the plane when the blade is half way through
  tick({blade({0.0205, -0.0093, 0.16}, {0.0205, 0.0701, 0.16}), {}});
  expectLikeTheReference();
  const HostState state = solver_->readState();
  size_t near_side = 0, far_side = 0;
  for (const uint32_t slot : lattice().active_slots) {
    if (lattice().nodeAt(slot).x() != 2) continue;
    bool lost[2] = {false, false};
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      const int dx = kNeighborOffsets[s][0];
      if (dx != 0 && springCount(lattice().nodes[slot], s) != springCount(state.nodes[slot], s)) lost[dx > 0] = true;
    }
    EXPECT_NE(lost[0], lost[1]) << lattice().nodeAt(slot).transpose();
    near_side += lost[1];
    far_side += lost[0];
  }
  EXPECT_GT(near_side, 7u);  // a row of seven nodes at least before the layer has passed, and one after it
  EXPECT_GT(far_side, 7u);
}

TEST_P(MovingCuts, ABladeThatGoesWithTheTissueCutsNothing) {
  write(drifting({0, 0.006, 0}));
  tick({});  // their previous motion is known from the second tick on
  tick({blade({0.0137, 0.0322, 0.16}, {0.0137, 0.0382, 0.16}), {}});  // 0.1 mm behind diagonals
  expectLikeTheReference();
  EXPECT_EQ(reference_->springs_cut, 0u);
}

TEST_P(MovingCuts, BothEndsAgreeHoweverTheirTissueMoves) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> angle(-180, 180);
  const Vector3d middle = Vector3d::Constant(0.03);
  uint32_t cut = 0;
  for (int t = 0; t < 12; ++t) {
    SCOPED_TRACE(t);
    reset();
    HostState state = drifting(randomVector(random, 0.03));
    for (const uint32_t slot : lattice().active_slots) {
      state.velocity_m_per_s[slot] =
          vec4(xyz(state.velocity_m_per_s[slot]) + randomVector(random, 0.05 * kMovingCutsSpacing_m / tick_s()));
    }
    write(state);
    ToolMotions motions;
    for (StylusMotion& motion : motions) {
      motion = blade(middle + randomVector(random, 0.08), middle + randomVector(random, 0.08));
      motion.from.orientation = rotationFromDegrees({angle(random), angle(random), angle(random)});
      motion.to.orientation = rotationFromDegrees({angle(random), angle(random), angle(random)});
    }
    tick(motions);
    expectLikeTheReference();
    cut += reference_->springs_cut;
  }
  EXPECT_GT(cut, 500u);
}
