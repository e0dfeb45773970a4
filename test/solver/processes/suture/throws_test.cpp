// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/chain/throws.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace viscera {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kTurns = 1e-3;

/// Returns one of two tails that are wound about each other within 3 mm and separate on both sides.
std::vector<Vector3d> tail(double turns, double phase) {
  constexpr double kHalf_m = 1.5e-3, kTail_m = 0.02;
  constexpr int kPieces = 20;
  std::vector<Vector3d> out;
  const auto at = [&](double x) {
    const double angle = 2 * kPi * turns * std::clamp((x + kHalf_m) / (2 * kHalf_m), 0.0, 1.0) + phase;
    const double radius_m = 2e-4 + 0.5 * std::max(0.0, std::abs(x) - kHalf_m);
    out.emplace_back(x, radius_m * std::cos(angle), radius_m * std::sin(angle));
  };
  for (int i = 0; i < kPieces; ++i) at(-kHalf_m - kTail_m * (kPieces - i) / kPieces);
  for (int i = 0; i <= 2 * kPieces; ++i) at(kHalf_m * (i - kPieces) / kPieces);
  for (int i = 1; i <= kPieces; ++i) at(kHalf_m + kTail_m * i / kPieces);
  return out;
}

Strand strandOf(const std::vector<Vector3d>& nodes) {
  return {nodes.data(), nodes.size()};
}

TEST(Throws, TurnsOfTwoTailsAreCounted) {
  for (const double turns : {0.0, 0.5, 1.0, 1.5, 2.0, -1.0}) {
    const std::vector<Vector3d> one = tail(turns, 0), other = tail(turns, kPi);
    EXPECT_NEAR(turnsOf(strandOf(one), strandOf(other)), turns, kTurns);
    EXPECT_NEAR(turnsOf(strandOf(other), strandOf(one)), turns, kTurns);
  }
}

TEST(Throws, LinkedRingsTurnOnce) {
  std::vector<Vector3d> one, other;
  for (int i = 0; i <= 40; ++i) {
    const double angle = 2 * kPi * i / 40;
    one.emplace_back(std::cos(angle), std::sin(angle), 0);
    other.emplace_back(1 + std::cos(angle), 0, std::sin(angle));
  }
  EXPECT_NEAR(std::abs(turnsOf(strandOf(one), strandOf(other))), 1, 1e-9);
  for (Vector3d& position : other) position.x() += 3;
  EXPECT_NEAR(turnsOf(strandOf(one), strandOf(other)), 0, 1e-9);
}

TEST(Throws, KnotKindFollowsFromTurnsAndSigns) {
  EXPECT_EQ(throwOf(0.6), 0);
  EXPECT_EQ(throwOf(-0.9), -1);
  EXPECT_EQ(throwOf(1.8), 2);
  EXPECT_EQ(kindOf({}), KnotKind::kNone);
  EXPECT_EQ(kindOf({0, 1}), KnotKind::kHalf);
  EXPECT_EQ(kindOf({-2}), KnotKind::kDoubleHalf);
  EXPECT_EQ(kindOf({1, -1}), KnotKind::kSquare);
  EXPECT_EQ(kindOf({-1, 1, -1}), KnotKind::kSquare);
  EXPECT_EQ(kindOf({1, 1}), KnotKind::kGranny);
  EXPECT_EQ(kindOf({1, -1, -1}), KnotKind::kGranny);
  EXPECT_EQ(kindOf({2, -1}), KnotKind::kSurgeons);
  EXPECT_EQ(kindOf({2, 1}), KnotKind::kSurgeonsGranny);
  EXPECT_STREQ(nameOf(kindOf({2, -1, 1})), "surgeons");
}

}  // namespace
}  // namespace viscera
