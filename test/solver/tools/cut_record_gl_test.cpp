// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Lattices record where their axial springs were cut (HostState::axial_cut).
#include "solver/network_rig.h"
#include "support/random_state.h"
#include "support/solver_rig.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kSpacing_m = 0.01;
constexpr int kSubsteps = 20;
constexpr double kBlade_m = 0.2;
constexpr double kLeastShare = 0.02;  // as in blade.glsl: a cut nearer to an end is not recorded
// In spacings: float32 positions of 0.1 m (6e-9 m) and vectors of 0.2 m from the blade's tip (1.2e-8 m), a few of them.
constexpr double kOnPlane = 1e-4;
constexpr double kUndecided_m = 1e-6;  // nodes nearer to the plane may count as on either side

StylusConfig stylusConfig() {
  StylusConfig config;
  config.button2 = ToolMode::kCut;
  config.cut.blade_length_m = kBlade_m;
  config.cut.blade_side = BladeSide::kAhead;
  config.cut_particles.eraser_radius_m = 0.004;
  return config;
}

/// A blade along -z of its own axes that sweeps from one position to the other, in these axes about the middle.
struct Sweep {
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  Vector3d from_m, to_m;
  ToolMode mode = ToolMode::kCut;
  Vector3d middle_m = Vector3d::Constant(3 * kSpacing_m);

  double distance(const Vector3d& x) const {
    return (turn * Vector3d::UnitZ().cross(to_m - from_m).normalized()).dot(x - (middle_m + turn * from_m));
  }
  ToolMotions motions() const {
    ToolMotions out = tool(mode, middle_m + turn * from_m, middle_m + turn * to_m);
    out[0].from.orientation = out[0].to.orientation = turn;
    return out;
  }
};

/// Returns a sweep along y through the whole body, `beside_m` from its middle.
Sweep turned(const Vector3d& degrees, double beside_m) {
  Sweep out;
  out.turn = rotationFromDegrees(degrees);
  out.from_m = {beside_m, -0.1, 0.1};
  out.to_m = {beside_m, 0.1, 0.1};
  return out;
}

const std::vector<Vector3d> kAngles_deg = {{0, 0, 0},     {0, 90, 0},   {90, 0, 90}, {0, 0, 45},   {0, 45, 0},
                                           {35.3, 0, 45}, {10, 20, 30}, {-5, 3, 88}, {60, -25, 7}, {1, 1, 1}};

class CutRecords : public BesideReference {
 protected:
  CutRecords() : BesideReference(kSubsteps, stylusConfig()) { use(modelOf({boxBody({6, 6, 6}, kSpacing_m)})); }
  using BesideReference::tick;
  void tick(const Sweep& sweep) { tick(sweep.motions()); }
  std::vector<float> record() const { return solver_->readState().axial_cut; }
  template <class Visit>
  void forEachAxialSpring(Visit visit) const {
    for (const uint32_t slot : lattice().active_slots) {
      for (uint32_t axis = 0; axis < 3; ++axis) {
        if (springCount(lattice().nodes[slot], 2 * axis) == 0) continue;
        visit(3 * slot + axis, slot, static_cast<uint32_t>(lattice().neighborSlot(slot, 2 * axis)));
      }
    }
  }
  /// Expects a record for all cut springs and for nothing else, in the slots of a body.
  void expectOfCutSprings(const HostState& state) const {
    ASSERT_EQ(state.axial_cut.size(), 3 * model_.slots());
    size_t recorded = 0, cut = 0;
    for (const float share : state.axial_cut) recorded += share != 0;
    forEachAxialSpring([&](size_t at, uint32_t slot, uint32_t) {
      const bool whole = springCount(state.nodes[slot], 2 * (at % 3)) != 0;
      EXPECT_EQ(state.axial_cut[at] == 0, whole) << at;
      cut += !whole;
    });
    EXPECT_EQ(recorded, cut);
  }
  void expectLikeTheReference() const {
    const std::vector<float> shares = record();
    ASSERT_EQ(shares.size(), reference_->axial_cut.size());
    for (size_t i = 0; i < shares.size(); ++i) ASSERT_NEAR(shares[i], reference_->axial_cut[i], kOnPlane) << i;
  }
};

INSTANTIATE_TEST_SUITE_P(Backends, CutRecords, ::testing::ValuesIn(backendNames()), backendSuffix);

}  // namespace

TEST_P(CutRecords, EveryCrossedSpringSaysWhereThePlaneOfTheBladeIs) {
  for (const Vector3d& angles : kAngles_deg) {
    for (const double beside_m : {0.0037, -0.0121}) {
      SCOPED_TRACE(::testing::Message() << angles.transpose() << ", beside " << beside_m);
      reset();
      const Sweep sweep = turned(angles, beside_m);
      tick(sweep);
      const HostState state = solver_->readState();
      expectOfCutSprings(state);
      expectLikeTheReference();
      size_t crossed = 0;
      forEachAxialSpring([&](size_t at, uint32_t slot, uint32_t far) {
        const Vector3d a = lattice().restPosition(slot), b = lattice().restPosition(far);
        const double da = sweep.distance(a), db = sweep.distance(b);
        if (std::min(std::abs(da), std::abs(db)) < kUndecided_m) return;
        ASSERT_EQ(state.axial_cut[at] != 0, (da > 0) != (db > 0)) << at;
        if ((da > 0) == (db > 0)) return;
        ++crossed;
        const double truth = std::clamp(da / (da - db), kLeastShare, 1 - kLeastShare);
        const double share = static_cast<double>(state.axial_cut[at]);
        EXPECT_LT(std::abs(share - truth) * std::abs(da - db), kOnPlane * kSpacing_m) << at;
      });
      EXPECT_GE(crossed, 40u);
    }
  }
}

/// The sweep of a blade that hardly moves is a sliver: its plane must not be lost in the rounding of a cross product.
TEST_P(CutRecords, ABladeThatHardlyMovesIsNotedAsWell) {
  constexpr double kShare = 0.37;
  const auto slot = static_cast<uint32_t>(lattice().slotAt({3, 3, 3}));
  for (const Vector3d& angles : std::vector<Vector3d>{{20, 30, 40}, {-50, 10, 70}, {10, -25, 130}}) {
    for (uint32_t axis = 0; axis < 3; ++axis) {
      SCOPED_TRACE(::testing::Message() << angles.transpose() << ", axis " << axis);
      reset();
      Sweep sweep = turned(angles, 0);
      sweep.middle_m += kShare * kSpacing_m * Vector3d::Unit(axis);
      // 1e-5 m in a substep, across the spring in the eleventh, a fifth of the substep after its start: there the sweep
      // is the triangle of two blades.
      sweep.from_m.y() = -1.02e-4;
      sweep.to_m.y() = 0.98e-4;
      tick(sweep);
      EXPECT_NEAR(static_cast<double>(record()[3 * slot + axis]), kShare, kOnPlane);
      expectLikeTheReference();
    }
  }
}

TEST_P(CutRecords, TheFirstCutOfASpringStays) {
  tick(turned({0, 0, 0}, 0.0037));
  const std::vector<float> first = record();
  tick(turned({0, 0, 0}, 0.0083));  // the same springs, elsewhere
  EXPECT_EQ(record(), first);
  tick(turned({10, 20, 30}, 0.001));
  const std::vector<float> third = record();
  size_t more = 0;
  for (size_t i = 0; i < first.size(); ++i) {
    if (first[i] != 0) {
      EXPECT_EQ(third[i], first[i]) << i;
    }
    more += first[i] == 0 && third[i] != 0;
  }
  EXPECT_GT(more, 20u);
  expectLikeTheReference();
}

TEST_P(CutRecords, ResetForgetsAll) {
  tick(turned({10, 20, 30}, 0.001));
  const std::vector<float> cut = record();
  solver_->reset();
  EXPECT_EQ(record(), std::vector<float>(3 * model_.slots()));
  solver_->step(turned({10, 20, 30}, 0.001).motions());
  EXPECT_EQ(record(), cut);
}

TEST_P(CutRecords, AreReadWhereSomethingMayHaveChangedAndNotElse) {
  CutState cuts;
  EXPECT_TRUE(solver_->readCuts(cuts));
  EXPECT_EQ(cuts.nodes.size(), model_.slots());
  EXPECT_EQ(cuts.axial_cut, std::vector<float>(3 * model_.slots()));
  EXPECT_FALSE(solver_->readCuts(cuts));
  const uint64_t before = cuts.revision;
  solver_->step({});
  EXPECT_FALSE(solver_->readCuts(cuts));
  tick(turned({10, 20, 30}, 0.001));
  EXPECT_TRUE(solver_->readCuts(cuts));
  EXPECT_GT(cuts.revision, before);
  const HostState state = solver_->readState();
  EXPECT_EQ(cuts.axial_cut, state.axial_cut);
  for (size_t i = 0; i < state.nodes.size(); ++i) EXPECT_EQ(cuts.nodes[i].lo, state.nodes[i].lo) << i;
  solver_->reset();
  EXPECT_TRUE(solver_->readCuts(cuts));
  EXPECT_EQ(cuts.axial_cut, std::vector<float>(3 * model_.slots()));
  EXPECT_FALSE(solver_->readCuts(cuts));
}

TEST_P(CutRecords, ComeWithTheSnapshotOfAState) {
  StateSnapshot snapshot;
  solver_->snapshot(snapshot);
  EXPECT_EQ(snapshot.axial_cut, std::vector<float>(3 * model_.slots()));
  tick(turned({10, 20, 30}, 0.001));
  solver_->snapshot(snapshot);
  EXPECT_EQ(snapshot.axial_cut, record());
}

TEST_P(CutRecords, WrittenStateBringsThemWithIt) {
  tick(turned({10, 20, 30}, 0.001));
  const HostState cut = solver_->readState();
  solver_->reset();
  solver_->writeState(cut);
  EXPECT_EQ(record(), cut.axial_cut);
  HostState whole = cut;
  whole.axial_cut.clear();
  EXPECT_EQ(stateHash(model_, whole), stateHash(model_, cut));  // the record of a cut does not affect the motion
  solver_->writeState(whole);
  EXPECT_EQ(record(), std::vector<float>(3 * model_.slots()));
}

TEST_P(CutRecords, AnErasedNodeIsTheEndThatHasNoSpringLeft) {
  tick(turned({0, 0, 0}, 0.0037));
  const std::vector<float> first = record();
  Sweep eraser = turned({10, 20, 30}, 0.001);
  eraser.mode = ToolMode::kCutParticles;
  tick(eraser);
  const HostState state = solver_->readState();
  expectOfCutSprings(state);
  expectLikeTheReference();
  size_t erased = 0, kept = 0;
  forEachAxialSpring([&](size_t at, uint32_t slot, uint32_t far) {
    const auto inReach = [&](uint32_t node) {
      const Vector3d x = lattice().restPosition(node);
      return std::abs(eraser.distance(x)) <= 0.004;
    };
    const auto alone = [&](uint32_t node) {
      return (state.nodes[node].lo & layout::kAxialMask) == 0 && (state.nodes[node].hi & layout::kDiagonalMask) == 0;
    };
    EXPECT_EQ(alone(slot), inReach(slot)) << at;
    const bool gone = inReach(slot) || inReach(far);
    EXPECT_EQ(state.axial_cut[at], first[at] != 0 ? first[at] : gone ? layout::kErasedShare : 0.0f) << at;
    erased += gone && first[at] == 0;
    kept += gone && first[at] != 0;
  });
  EXPECT_GT(erased, 100u);
  EXPECT_GT(kept, 20u);
}

TEST_P(CutRecords, ExplicitLatticesHaveTheSame) {
  Sweep eraser = turned({90, 0, 90}, -0.02);
  eraser.mode = ToolMode::kCutParticles;
  const auto cutAll = [&] {
    std::vector<std::vector<float>> out;
    for (const Vector3d& angles : kAngles_deg) {
      reset();
      tick(turned(angles, 0.0037));
      tick(eraser);
      expectLikeTheReference();
      CutState cuts;
      solver_->readCuts(cuts);
      out.push_back(cuts.axial_cut);
    }
    return out;
  };
  const std::vector<std::vector<float>> implicit = cutAll();
  use(modelOf({withLinks(boxBody({6, 6, 6}, kSpacing_m))}));
  const std::vector<std::vector<float>> linked = cutAll();
  for (size_t a = 0; a < implicit.size(); ++a) {
    ASSERT_EQ(linked[a].size(), implicit[a].size());
    for (size_t i = 0; i < linked[a].size(); ++i) ASSERT_NEAR(linked[a][i], implicit[a][i], kOnPlane) << a << ", " << i;
  }
}

/// Nodes outside their tissue: the tissue decides whether a spring is cut, the nodes where.
TEST_P(CutRecords, WhereCellsArePartlyFilledTheyAreOfTheNodes) {
  Scene scene;
  scene.bodies.emplace_back();
  scene.bodies[0].source = TissueSource::kBox;
  scene.bodies[0].box_size_m = {0.06, 0.06, 0.0573};  // its upper nodes are outside, about the origin
  scene.bodies[0].spacing_m = kSpacing_m;
  use(buildModel(scene));
  size_t outside = 0;
  for (const Vector3d& angles : kAngles_deg) {
    SCOPED_TRACE(::testing::Message() << angles.transpose());
    reset();
    Sweep sweep = turned(angles, 0.0037);
    sweep.middle_m = Vector3d::Zero();
    tick(sweep);
    expectOfCutSprings(solver_->readState());
    expectLikeTheReference();
    const std::vector<float> shares = record();
    forEachAxialSpring([&](size_t at, uint32_t slot, uint32_t) {
      outside += shares[at] != 0 && !reference_->offsetToSurface(reference_->u_m, slot).isZero();
    });
  }
  EXPECT_GT(outside, 50u);
}

TEST_P(CutRecords, OfTwoBodiesAreEachOnesOwn) {
  Body high = boxBody({3, 4, 2}, kSpacing_m);
  high.lattice.origin_m = {0.01, 0.01, 0.061};
  use(modelOf({clothBody(4, 4, 0.01), withLinks(boxBody({6, 6, 6}, kSpacing_m)), high}));
  tick(turned({10, 20, 30}, 0.001));
  expectLikeTheReference();
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const std::vector<float> shares = record();
    const auto first = shares.begin() + 3 * static_cast<std::ptrdiff_t>(model_.slotOffset(b));
    const auto slots = static_cast<std::ptrdiff_t>(model_.bodies[b].lattice.nodes.size());
    EXPECT_EQ(std::all_of(first, first + 3 * slots, [](float share) { return share == 0; }), b == 0) << b;
  }
}

TEST_P(CutRecords, CutsOfATickThatIsTakenBackStayWithWhatIsKnownOfThem) {
  Scene scene = sceneFor(model_, kSubsteps, styluses_);
  scene.solver.stability_monitor = true;
  scene.solver.dt_fraction = scene.solver.dt_fraction_strained = 10;
  scene.solver.tick_hz /= 20;
  SolverOptions unstable;
  unstable.allow_unstable = true;
  solver_ = make(model_, scene, unstable);
  solver_->writeState(randomState(model_, 0.1 * kSpacing_m, 0.1, 5));
  for (int t = 0; t < 4; ++t) {
    solver_->step(turned({10, 20, 30}, -0.004 + 0.003 * t).motions());
    const HostState state = solver_->readState();
    expectOfCutSprings(state);
    for (const float share : state.axial_cut) {
      EXPECT_TRUE(share == 0 ||
                  (share >= static_cast<float>(kLeastShare) && share <= 1 - static_cast<float>(kLeastShare)))
          << share;
    }
  }
  EXPECT_GT(solver_->health().trips, 0u);
}

TEST_P(CutRecords, AreNotMadeWhereNoToolCuts) {
  for (StylusConfig& config : styluses_) config.idle = config.button1 = config.button2 = ToolMode::kProbe;
  use(model_);
  EXPECT_TRUE(record().empty());
  tick(turned({0, 0, 0}, 0.0037));  // requested nevertheless, it returns the cut, without a record
  EXPECT_TRUE(record().empty());
  CutState cuts;
  EXPECT_TRUE(solver_->readCuts(cuts));
  EXPECT_TRUE(cuts.axial_cut.empty());
  EXPECT_GT(reference_->springs_cut, 0u);
  for (const uint32_t slot : reference_->active) {
    EXPECT_EQ(cuts.nodes[slot].lo & layout::kAxialMask, reference_->nodes[slot].lo & layout::kAxialMask) << slot;
  }
}
