// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ticks/unfold.h"

#include <gtest/gtest.h>

#include "math/float_bits.h"
#include "solver/tissue/fields.h"
#include "support/gpu_fixture.h"
#include "support/lattices.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kUnfoldSpacing_m = 0.01;
// Displacements of up to 0.04 m in float32, a few times rounded [m].
constexpr double kRounding_m = 3e-8;

/// A block of 6^3 cells, stretched, turned and sheared by an affine motion, held at its bottom.
class Unfold : public ::testing::Test {
 protected:
  Unfold() : model_(modelOf({boxBody({6, 6, 6}, kUnfoldSpacing_m)})), state_(restState(model_)) {
    motion_ << 0.1, -0.6, 0.1, 0.5, 0.05, 0, 0.1, 0, -0.1;
    for (const uint32_t slot : lattice().active_slots) {
      put(slot, affine(slot));
      if (lattice().nodeAt(slot).z() == 0) state_.nodes[slot].lo |= layout::kFixedBit;
    }
  }
  const Lattice& lattice() const { return model_.bodies[0].lattice; }
  uint32_t slot(int x, int y, int z) const { return static_cast<uint32_t>(lattice().slotAt({x, y, z})); }
  Vector3d affine(uint32_t slot) const { return motion_ * lattice().restPosition(slot); }
  void put(uint32_t slot, const Vector3d& u_m) {
    state_.displacement_m[slot] = {static_cast<float>(u_m.x()), static_cast<float>(u_m.y()),
                                   static_cast<float>(u_m.z()), 0};
  }
  /// The node goes so far through those around it.
  void push(uint32_t slot, const Vector3d& way) { put(slot, affine(slot) + kUnfoldSpacing_m * way); }
  double strayed() const {
    double out = 0;
    for (const uint32_t slot : lattice().active_slots)
      out = std::max(out, (xyz(state_.displacement_m[slot]) - affine(slot)).norm());
    return out;
  }

  Model model_;
  HostState state_;
  Eigen::Matrix3d motion_;
};

TEST_F(Unfold, UprightTissueIsLeftAloneHoweverItLies) {
  const HostState before = state_;
  EXPECT_EQ(unfold(model_, state_), 0U);
  for (const uint32_t slot : lattice().active_slots)
    EXPECT_EQ(xyz(state_.displacement_m[slot]), xyz(before.displacement_m[slot]));
}

TEST_F(Unfold, NodesThatWentThroughOthersComeBackToWhereThoseAroundThemHaveThem) {
  push(slot(3, 3, 3), {1.7, 0, 0});
  push(slot(3, 4, 6), {0.3, 0.2, -2.5});
  state_.velocity_m_per_s[slot(3, 3, 3)] = {3, 0, 0, 0};
  EXPECT_GT(unfold(model_, state_), 2U);
  EXPECT_LT(strayed(), kRounding_m);
  EXPECT_LT(xyz(state_.velocity_m_per_s[slot(3, 3, 3)]).norm(), 1e-9);
}

TEST_F(Unfold, LayersThatWentThroughEachOtherComeBackToo) {
  for (int x = 1; x < 6; ++x)
    for (int y = 1; y < 6; ++y)
      for (int z = 4; z <= 6; ++z) push(slot(x, y, z), {0, 0, -2.0});
  EXPECT_GT(unfold(model_, state_), 0U);
  EXPECT_EQ(unfold(model_, state_), 0U);  // nothing is left
}

TEST_F(Unfold, FixedNodesStay) {
  push(slot(3, 3, 0), {0, 0, 2.5});
  unfold(model_, state_);
  EXPECT_LT((xyz(state_.displacement_m[slot(3, 3, 0)]) - affine(slot(3, 3, 0)) - Vector3d(0, 0, 2.5 * kUnfoldSpacing_m))
                .norm(),
            kRounding_m);
}

TEST_F(Unfold, CutCellsAreNobodysConcern) {
  const uint32_t corner = slot(6, 6, 6);
  for (int c = 0; c < 8; ++c) {
    const int64_t cell = lattice().slotAt(Vector3i(6, 6, 6) - Vector3i(c & 1, c >> 1 & 1, c >> 2));
    if (cell >= 0) state_.nodes[static_cast<size_t>(cell)].lo &= ~layout::kCellBit;
  }
  push(corner, {-3, 0, 0});
  EXPECT_EQ(unfold(model_, state_), 0U);
}

TEST_F(Unfold, MirroredTissueThatHangsNowhereStaysAsItIs) {
  for (const uint32_t slot : lattice().active_slots) {
    state_.nodes[slot].lo &= ~layout::kFixedBit;
    put(slot, {-2 * lattice().restPosition(slot).x(), 0, 0});
  }
  const HostState before = state_;
  EXPECT_EQ(unfold(model_, state_), 0U);
  for (const uint32_t slot : lattice().active_slots)
    EXPECT_EQ(xyz(state_.displacement_m[slot]), xyz(before.displacement_m[slot]));
}

layout::TickStats tick(bool touched, float stretch) {
  layout::TickStats stats{};
  stats.touched[0] = touched ? 3 : 0;
  stats.max_stretch_bits = bitsOfFloat(stretch);
  return stats;
}

int dueIn(FoldWatch& watch, float stretch, int most) {
  for (int t = 1; t <= most; ++t)
    if (watch.isDue(tick(false, stretch))) return t;
  return 0;
}

TEST(FoldWatch, LooksHalfASecondAfterToolsHaveLeftAndOnlyAtStrainedTissue) {
  constexpr double kTick_s = 0.01;
  FoldWatch watch(kTick_s);
  EXPECT_EQ(dueIn(watch, 0.9f, 200), 0);  // no tool was there
  EXPECT_FALSE(watch.isDue(tick(true, 0.9f)));
  EXPECT_EQ(dueIn(watch, 0.9f, 200), 50);
  watch.found(0);
  EXPECT_EQ(dueIn(watch, 0.9f, 200), 0);
  EXPECT_FALSE(watch.isDue(tick(true, 0.9f)));
  EXPECT_EQ(dueIn(watch, 0.1f, 200), 0);
}

TEST(FoldWatch, LooksAgainWhereFoldsAreFoundButNotForEver) {
  FoldWatch watch(0.01);
  EXPECT_FALSE(watch.isDue(tick(true, 0.9f)));
  int looks = 0;
  for (int t = 0; t < 1000; ++t) {
    if (!watch.isDue(tick(false, 0.9f))) continue;
    ++looks;
    watch.found(5);
  }
  EXPECT_EQ(looks, 3);
}

}  // namespace
}  // namespace viscera
