// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/kernels/tool_passes.h"

#include "support/features.h"
#include "support/random_state.h"
#include "tools/motion_packing.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr float kToolPassesDt_s = 1e-4f;
// Absolute positions of up to 0.2 m in float32, rounded a few times [m].
constexpr double kPosition_m = 4 * 0.2 / (1 << 24);
// Springs that are touched add the roundings of both ends in each round.
constexpr double kEdges_m = 2 * kPosition_m;
constexpr double kVelocity_m_per_s = kPosition_m / static_cast<double>(kToolPassesDt_s);

Vector3f single(const Vector3d& v) {
  return v.cast<float>();
}

layout::ToolMotion row(ToolMode mode, const Pose& from, const Pose& to) {
  StylusConfig config;
  config.probe.radius_m = 0.012;
  config.cut.blade_length_m = 0.08;
  config.cut.blade_side = BladeSide::kAhead;
  config.cut_particles.eraser_radius_m = 0.004;
  ToolMotions motions;
  motions[0].mode = mode;
  motions[0].present = true;
  motions[0].from = from;
  motions[0].to = to;
  std::vector<layout::ToolMotion> rows;
  interpolateMotions(motions, {config, config}, 1, rows);
  return rows[0];
}

Pose at(const Vector3d& position_m, const Vector3d& turns_deg = Vector3d::Zero()) {
  return {position_m, rotationFromDegrees(turns_deg)};
}

class CpuTools : public ::testing::Test {
 protected:
  CpuTools()
      : model_(modelOf({rubberBox()})),
        lattice_(model_, bodyParams(model_, safeTimeStep(model_)), featuresFor(model_, true)),
        reference_(model_, Vector3d::Zero(), static_cast<double>(kToolPassesDt_s), options()) {}

  /// Returns six cells of a law per edge, fixed at the bottom; two bricks per edge.
  static Body rubberBox() {
    Body body = ofLaw(boxBody({6, 6, 6}, 0.01), 0.4);
    body.material.stiffness_damping_ratio = body.material.mass_damping_per_s = 0;
    for (uint32_t slot : body.lattice.active_slots) {
      if (body.lattice.nodeAt(slot).z() == 0) body.lattice.nodes[slot].lo |= layout::kFixedBit;
    }
    return body;
  }
  static ReferenceOptions options() {
    ReferenceOptions out;
    out.push_speed_m_per_s = 20;
    return out;
  }

  void write(const HostState& state) {
    lattice_.write(state);
    load(reference_, state);
    reference_.restart();
  }
  /// Returns a state with everything displaced and moving alike: no force acts, and a substep is the effect of tools
  /// alone.
  HostState drifting(const Vector3d& u_m, const Vector3d& v_m_per_s) {
    HostState state = restState(model_);
    for (uint32_t slot : lattice_.store.active) {
      if (isFixed(state.nodes[slot])) state.nodes[slot].lo &= ~layout::kFixedBit;
      state.displacement_m[slot] = vec4(u_m);
      state.velocity_m_per_s[slot] = vec4(v_m_per_s);
    }
    return state;
  }
  /// Makes a substep of both, tools alone. @return number of nodes that a tool moved
  size_t expectSameSubstep(const layout::ToolMotion (&motions)[2]) {
    reference_.impulse_n_s = {Vector3d::Zero(), Vector3d::Zero()};
    reference_.substep({motions[0], motions[1]});
    const HostState before = lattice_.read();
    HostState after = before;
    float* const u_next = lattice_.state.displacement[1 - lattice_.state.current].data();
    float* const v_next = lattice_.state.velocity[1 - lattice_.state.current].data();
    size_t moved = 0;
    for (uint32_t slot : lattice_.store.active) {
      const Vector3d u = xyz(before.displacement_m[slot]), v = xyz(before.velocity_m_per_s[slot]);
      setPlanes(u_next, slot, single(u + static_cast<double>(kToolPassesDt_s) * v));
      setPlanes(v_next, slot, single(v));
    }
    Substep step;
    step.dt_s = kToolPassesDt_s;
    step.push_speed_m_per_s = 20;
    step.edge_reach_m = edgeReach(model_);
    const std::vector<uint32_t>& slots = lattice_.store.active;
    resolveContacts(lattice_, step, motions, slots.data(), slots.size());
    CpuEdges edges(lattice_.slotCount());
    edges.add(lattice_, step, motions, slots.data(), slots.size());
    edges.run(lattice_, step, motions);
    for (uint32_t slot : slots) {
      const Vector3d u = planesAt(u_next, slot).cast<double>(), v = planesAt(v_next, slot).cast<double>();
      moved += v != xyz(before.velocity_m_per_s[slot]);
      EXPECT_LT((u - reference_.u_m[slot]).norm(), kEdges_m) << slot;
      EXPECT_LT((v - reference_.v_m_per_s[slot]).norm(), 3 * kVelocity_m_per_s) << slot;
      after.displacement_m[slot] = vec4(u);
      after.velocity_m_per_s[slot] = vec4(v);
    }
    lattice_.write(after);
    return moved;
  }
  layout::TickStats reactions(const Vector3d& tip0, const Vector3d& tip1 = Vector3d::Zero()) {
    layout::TickStats stats{};
    sumReactions(lattice_, {single(tip0), single(tip1)}, stats);
    return stats;
  }
  uint32_t cutBoth(const layout::ToolMotion& motion) {
    reference_.substep({motion, {}});
    const uint32_t springs = cut_.run(lattice_, motion, motion.info.x == layout::kModeCutParticles);
    cut_.tearCells(lattice_);
    return springs;
  }

  Model model_;
  CpuLattice lattice_;
  Serial serial_;
  CpuCut cut_{lattice_, serial_, *simd::kernelsFor({})};
  ReferenceSolver reference_;
};

}  // namespace

TEST_F(CpuTools, ProbesPushNodesLikeTheReferences) {
  std::mt19937 random(3);
  size_t moved = 0;
  for (int t = 0; t < 20; ++t) {
    SCOPED_TRACE(t);
    write(drifting(randomVector(random, 0.01), randomVector(random, 1)));
    const Vector3d a = Vector3d(0.03, 0.03, 0.05) + randomVector(random, 0.03);
    const Vector3d b = Vector3d(0.02, 0.04, 0.05) + randomVector(random, 0.03);
    moved += expectSameSubstep({row(ToolMode::kProbe, at(a), at(a + randomVector(random, 2e-3))),
                                row(ToolMode::kProbe, at(b), at(b + randomVector(random, 0.03)))});
    const layout::TickStats stats = reactions(a, b);
    for (size_t s = 0; s < 2; ++s) {
      const Vector3d truth = reference_.impulse_n_s[s];
      // Roundings of velocities, times the mass of a node, for every touched node.
      const double allowed =
          3 * kVelocity_m_per_s * static_cast<double>(lattice_.strengths.mass[lattice_.store.active[60]]);
      EXPECT_LT((xyz(stats.impulse[s]) - truth).norm(), allowed * (1 + stats.touched[s]));
    }
  }
  EXPECT_GT(moved, 100u);
}

TEST_F(CpuTools, HeldNodesFollowTheirStylusLikeTheReferences) {
  write(drifting(Vector3d(1e-3, 2e-3, -1e-3), Vector3d::Zero()));
  const Pose start = at({0.03, 0.03, 0.06}, {10, 20, 30});
  takeHold(lattice_, 1, start, 0.013);
  reference_.takeHold(1, start, 0.013);
  size_t held = 0;
  for (uint32_t slot : lattice_.store.active) {
    EXPECT_EQ(lattice_.store.nodes[slot].lo, reference_.nodes[slot].lo);
    if (reference_.heldBy(slot) != 2) continue;
    ++held;
    EXPECT_GT(lattice_.strengths.mobility[slot], 0);
  }
  EXPECT_GT(held, 3u);
  const layout::ToolMotion motion = row(ToolMode::kGrab, start, at({0.032, 0.03, 0.07}, {20, 20, 50}));
  EXPECT_EQ(expectSameSubstep({{}, motion}), held);
  const layout::TickStats stats = reactions(Vector3d::Zero(), {0.032, 0.03, 0.07});
  EXPECT_EQ(stats.touched[1], held);
  EXPECT_EQ(stats.touched[0], 0u);
}

TEST_F(CpuTools, ReleasedNodesAreFreeAndNoFasterThanTheReleaseSpeed) {
  write(drifting(Vector3d::Zero(), Vector3d(0, 0.5, 0)));
  const Pose pose = at({0.03, 0.03, 0.06});
  takeHold(lattice_, 0, pose, 0.012);
  const std::vector<layout::NodeBits> held = lattice_.store.nodes;
  letGo(lattice_, 1, {0.1}, {});  // the other stylus holds nothing
  EXPECT_EQ(lattice_.store.nodes[lattice_.store.active[0]].lo, held[lattice_.store.active[0]].lo);
  letGo(lattice_, 0, {0.1}, {});
  const HostState state = lattice_.read();
  size_t slowed = 0;
  for (uint32_t slot : lattice_.store.active) {
    EXPECT_EQ(lattice_.store.nodes[slot].lo & layout::kGrabMask, 0u);
    EXPECT_FLOAT_EQ(lattice_.strengths.mobility[slot], 1 / lattice_.strengths.mass[slot]);
    const bool was_held = (held[slot].lo & layout::kGrabMask) != 0;
    slowed += was_held;
    EXPECT_FLOAT_EQ(state.velocity_m_per_s[slot].y, was_held ? 0.1f : 0.5f);
  }
  EXPECT_GT(slowed, 3u);
}

TEST_F(CpuTools, HoldNeitherFixedNodesNorWhatAnotherStylusHolds) {
  write(restState(model_));
  const Pose low = at({0.03, 0.03, 0.005});
  takeHold(lattice_, 0, low, 0.012);
  const std::vector<layout::NodeBits> first = lattice_.store.nodes;
  takeHold(lattice_, 1, low, 0.012);
  for (uint32_t slot : lattice_.store.active) {
    EXPECT_EQ(lattice_.store.nodes[slot].lo, first[slot].lo);
    EXPECT_FALSE(isFixed(first[slot]) && (first[slot].lo & layout::kGrabMask) != 0) << slot;
  }
}

TEST_F(CpuTools, CutTheSpringsAndCellsThatTheReferenceCuts) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> angle(-180, 180);
  uint32_t cut = 0;
  for (int t = 0; t < 60; ++t) {
    SCOPED_TRACE(t);
    HostState state = randomState(model_, 2e-3, 0, static_cast<uint32_t>(t));
    if (t % 10 != 0) state.nodes = lattice_.store.nodes;  // cuts accumulate, then all is whole again
    write(state);
    const Vector3d turns(angle(random), angle(random), angle(random));
    const Vector3d from = Vector3d::Constant(0.03) + randomVector(random, 0.08);
    const ToolMode mode = t % 5 == 4 ? ToolMode::kCutParticles : ToolMode::kCut;
    cut += cutBoth(row(mode, at(from, turns), at(from + randomVector(random, 0.05), turns + randomVector(random, 20))));
    const CpuLattice fresh = [&] {
      CpuLattice out(model_, lattice_.store.bodies, featuresFor(model_, true));
      out.write(lattice_.read());
      return out;
    }();
    for (uint32_t slot : lattice_.store.active) {
      ASSERT_EQ(lattice_.store.nodes[slot].lo, reference_.nodes[slot].lo) << slot;
      ASSERT_EQ(lattice_.store.nodes[slot].hi, reference_.nodes[slot].hi) << slot;
      ASSERT_EQ(lattice_.strengths.mobility[slot], fresh.strengths.mobility[slot]);
      ASSERT_EQ(lattice_.strengths.bulk[slot], fresh.strengths.bulk[slot]);
    }
    ASSERT_EQ(lattice_.strengths.stiffness,
              fresh.strengths.stiffness);  // data derived from the bits was updated with them
  }
  EXPECT_GT(cut, 500u);
  EXPECT_EQ(cut, reference_.springs_cut);
}

TEST_F(CpuTools, VisitOnlyBricksThatTheBladeMayReach) {
  const Model model = modelOf({boxBody({63, 3, 3}, 0.001)});
  CpuLattice lattice(model, bodyParams(model, safeTimeStep(model)), featuresFor(model, true));
  const Serial serial;
  CpuCut cut(lattice, serial, *simd::kernelsFor({}));
  const layout::ToolMotion motion = row(ToolMode::kCut, at({0.0005, -0.001, 0.005}), at({0.0005, 0.004, 0.005}));
  EXPECT_EQ(cut.run(lattice, motion, false), 4u * 4 + 2 * (2 * 3 * 4));  // all springs between two layers of 4 x 4
  // The blade is 80 mm long and points down: its sphere has a radius of 40 mm plus 12 mm for long springs.
  EXPECT_GT(cut.bricks().size(), 0u);
  EXPECT_LT(cut.bricks().size(), lattice.brickCount());
  HostState state = restState(model);  // tissue that was pulled away is found at its position
  for (uint32_t slot : lattice.store.active) state.displacement_m[slot].x = 1;
  lattice.write(state);
  EXPECT_EQ(cut.run(lattice, motion, false), 0u);
  EXPECT_EQ(cut.bricks().size(), 0u);
}

/// A blade that does not move, one without length, one that only turns: boxes of any shape.
TEST_F(CpuTools, CutWhatTheReferenceCutsHoweverTheBladeMoves) {
  const Pose here = at({0.031, 0.032, 0.05}, {10, 20, 30}), turned = at({0.031, 0.032, 0.05}, {15, 20, 60});
  const Pose along = {here * Vector3d(0, 0, -0.02), here.orientation};
  for (const Pose& to : {here, turned, along}) {
    for (const ToolMode mode : {ToolMode::kCut, ToolMode::kCutParticles}) {
      for (const bool short_blade : {false, true}) {
        write(restState(model_));
        layout::ToolMotion motion = row(mode, here, to);
        if (short_blade) {
          motion.blade_to = {motion.to.x, motion.to.y, motion.to.z, motion.blade_to.w};
          motion.blade_from = {motion.from.x, motion.from.y, motion.from.z, motion.blade_from.w};
        }
        const uint32_t before = reference_.springs_cut;
        const uint32_t cut = cutBoth(motion);
        EXPECT_EQ(cut, reference_.springs_cut - before);
        EXPECT_TRUE(cut > 0 || mode == ToolMode::kCut);
      }
    }
  }
}

TEST_F(CpuTools, ReactionsAreSummedOnceAndThenForgotten) {
  write(drifting(Vector3d::Zero(), Vector3d(0, 0, 1)));
  const Vector3d tip(0.03, 0.03, 0.07);
  expectSameSubstep({row(ToolMode::kProbe, at(tip), at(tip)), {}});
  const std::vector<layout::vec4> given = lattice_.tools.impulses;
  const HostState state = lattice_.read();
  Vector3d impulse = Vector3d::Zero(), angular = Vector3d::Zero();
  for (uint32_t slot : lattice_.store.active) {
    impulse += xyz(given[slot]);
    angular += (reference_.restPosition(slot) + xyz(state.displacement_m[slot]) - tip).cross(xyz(given[slot]));
  }
  const layout::TickStats stats = reactions(tip);
  EXPECT_GT(stats.touched[0], 0u);
  EXPECT_LT((xyz(stats.impulse[0]) - impulse).norm(), 1e-6 * impulse.norm());  // float32 of the result
  EXPECT_LT((xyz(stats.angular[0]) - angular).norm(), kPosition_m * impulse.norm());
  const layout::TickStats later = reactions(tip);
  EXPECT_EQ(later.touched[0], 0u);
  EXPECT_EQ(xyz(later.impulse[0]), Vector3d::Zero().eval());
}
