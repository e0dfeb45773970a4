// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/pivot.h"

#include <gtest/gtest.h>

#include <random>

#include "support/text.h"

namespace viscera {
namespace {

using test::says;

const Vector3d kTip_m(0.01, -0.02, 0.14), kPivot_m(0.3, -0.2, 0.05);
constexpr double kNoise_m = 2e-4;  ///< per coordinate, for an optical tracker
constexpr double kRounding_m = 1e-12;

/// Returns poses of a device that is tilted to all sides about a fixed tip.
std::vector<Pose> pivoting(size_t count, double tilt_rad, double noise_m, uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> turn(0, 2 * M_PI);
  std::vector<Pose> poses;
  for (size_t i = 0; i < count; ++i) {
    const double heading = turn(random);
    const Quaterniond tilted(Eigen::AngleAxisd(tilt_rad, Vector3d(std::cos(heading), std::sin(heading), 0)));
    const Vector3d error(normal(random), normal(random), normal(random));
    poses.push_back({kPivot_m - tilted * kTip_m + noise_m * error, tilted});
  }
  return poses;
}

std::string refusal(const std::vector<Pose>& poses) {
  try {
    solvePivot(poses, {});
  } catch (const RegistrationError& error) {
    return error.what();
  }
  return "";
}

TEST(Pivot, ExactPosesGiveTipAndPivot) {
  const Pivot pivot = solvePivot(pivoting(50, 0.5, 0), {});
  EXPECT_LT((pivot.tip_m - kTip_m).norm(), kRounding_m);
  EXPECT_LT((pivot.pivot_m - kPivot_m).norm(), kRounding_m);
  EXPECT_LT(pivot.residual_m, kRounding_m);
}

TEST(Pivot, ResidualIsThatOfTheNoise) {
  // Six parameters are fitted to 3 N numbers with this error: the expected square of the residual is
  // sigma^2 (3 - 6 / N).
  constexpr size_t kPoses = 40, kRounds = 50;
  double squares = 0, tip_squares = 0;
  for (uint32_t seed = 0; seed < kRounds; ++seed) {
    const Pivot pivot = solvePivot(pivoting(kPoses, 0.5, kNoise_m, seed), {});
    squares += pivot.residual_m * pivot.residual_m / kRounds;
    tip_squares += (pivot.tip_m - kTip_m).squaredNorm() / kRounds;
  }
  const double expected_m = kNoise_m * std::sqrt(3 - 6.0 / kPoses);
  // 50 rounds of 114 degrees of freedom: the mean square has a relative deviation of 1.9 %; the tolerance is five of
  // these
  EXPECT_NEAR(squares / (expected_m * expected_m), 1, 0.1);
  EXPECT_LT(std::sqrt(tip_squares), 5 * kNoise_m / std::sqrt(kPoses) / 0.2);  // about 1 / turned
}

TEST(Pivot, TooFewPosesAreRefused) {
  EXPECT_TRUE(says(refusal(pivoting(kLeastPivotPoses - 1, 0.5, 0)), {"20 poses", "19"}));
}

TEST(Pivot, TooLittleRotationIsRefused) {
  EXPECT_TRUE(says(refusal(pivoting(100, 0.02, 0)), {"turned too little"}));
  EXPECT_TRUE(says(refusal(std::vector<Pose>(100)), {"turned too little"}));
}

TEST(Pivot, RotationAboutOneAxisIsRefused) {
  std::vector<Pose> poses;
  for (int i = 0; i < 100; ++i) {
    const Quaterniond turn(Eigen::AngleAxisd(0.05 * i, Vector3d::UnitX()));
    poses.push_back({kPivot_m - turn * kTip_m, turn});
  }
  EXPECT_TRUE(says(refusal(poses), {"only one axis"}));
}

TEST(Pivot, TipThatMovedIsRefused) {
  std::vector<Pose> poses = pivoting(100, 0.5, 0);
  for (size_t i = 50; i < poses.size(); ++i) poses[i].position_m.x() += 0.01;
  EXPECT_TRUE(says(refusal(poses), {"did not stay in place", "at most 3.00 mm"}));
}

}  // namespace
}  // namespace viscera
