// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/skins/smooth_shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "viscera/model/shape/solid.h"

namespace viscera {
namespace {

constexpr double kSlabStep_m = 0.002;
constexpr float kOutOfRound = 0.12F;  // of the share of the node: along an axis against along a diagonal
constexpr float kSameShare = 1e-5F;   // rounding of sums of 27 shares

class SmoothSharesOfSlab : public ::testing::Test {
 protected:
  Lattice lattice_ = buildLattice(boxSolid({-0.01, -0.01, 0}, {0.02, 0.02, 0.006}, kSlabStep_m), Weights::kCell);
  std::vector<float> shares_ = std::vector<float>(lattice_.nodes.size(), 0);
  float topZ() const {
    return static_cast<float>(lattice_.origin_m.z() + kSlabStep_m * (lattice_.nodes_per_axis.z() - 1));
  }
  /// Gives a share to the nodes for which `is_painted` holds.
  template <class Is>
  void paint(Is is_painted) {
    for (const uint32_t slot : lattice_.active_slots) {
      const Vector3d at = lattice_.restPosition(slot);
      if (is_painted(at)) shares_[slot] = 1;
    }
  }
  float at(double x, double y) const {
    return SmoothShares(lattice_, shares_.data()).at({static_cast<float>(x), static_cast<float>(y), topZ()});
  }
};

TEST_F(SmoothSharesOfSlab, ASingleNodeIsRound) {
  paint([&](const Vector3d& p) { return (p - Vector3d(0, 0, topZ())).norm() < 0.5 * kSlabStep_m; });
  ASSERT_EQ(std::count(shares_.begin(), shares_.end(), 1.F), 1);
  EXPECT_GT(at(0, 0), 0.3F);
  for (const double radius : {0.5, 1.0, 1.5}) {
    const double r = radius * kSlabStep_m, across = r / std::sqrt(2.0);
    EXPECT_NEAR(at(r, 0), at(across, across), kOutOfRound) << radius << " spacings away";
    EXPECT_LE(at(r, 0), at(0, 0));
  }
  EXPECT_EQ(at(3 * kSlabStep_m, 0), 0);
}

TEST_F(SmoothSharesOfSlab, ALineKeepsItsShareAndHasStraightBorders) {
  paint([](const Vector3d& p) { return std::abs(p.y()) < 0.5 * kSlabStep_m; });
  EXPECT_NEAR(at(0, 0), 1, kSameShare);
  EXPECT_NEAR(at(0.3 * kSlabStep_m, 0.8 * kSlabStep_m), at(0, 0.8 * kSlabStep_m), kSameShare);
  EXPECT_LT(at(0, 1.5 * kSlabStep_m), 0.5F);
}

TEST_F(SmoothSharesOfSlab, WhatIsAllPaintedStays) {
  std::fill(shares_.begin(), shares_.end(), 1.F);
  for (const double x : {-0.0099, -0.003, 0.0, 0.0071}) EXPECT_NEAR(at(x, 0.002), 1, kSameShare);
  std::fill(shares_.begin(), shares_.end(), 0.F);
  EXPECT_EQ(at(0, 0), 0);
}

}  // namespace
}  // namespace viscera
