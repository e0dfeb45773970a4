// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "math/decompositions.h"

#include <gtest/gtest.h>

namespace viscera::test {
namespace {

constexpr double kRounding = 1e-14;  // of lengths of 1: some ten roundings

TEST(Decompositions, TheShortestRotationTurnsOneDirectionIntoTheOther) {
  const Vector3d from(0.3, -2, 0.7);
  for (const Vector3d& to :
       {Vector3d(1, 0.2, -0.4), Vector3d(from), Vector3d(-from), Vector3d(-from + Vector3d(0, 0, 1e-7))}) {
    const Quaterniond turn = rotationBetween(from, to);
    EXPECT_NEAR(turn.norm(), 1, kRounding);
    // A hair from opposite, the axis is known to 1e-7 of a direction only.
    EXPECT_LT((turn * from.normalized() - to.normalized()).norm(),
              to.normalized().dot(from.normalized()) < 0 ? 1e-6 : kRounding);
  }
}

TEST(Decompositions, ARigidMotionIsFoundAgainAndIsNeverAMirror) {
  const Pose pose{{0.1, -0.2, 0.3}, Quaterniond(0.9, 0.1, -0.3, 0.2).normalized()};
  Eigen::Matrix3Xd from(3, 4), to(3, 4), mirrored(3, 4);
  from << 0, 1, 0, 0.2, 0, 0, 1, 0.4, 0, 0, 0, 0.9;
  for (Eigen::Index i = 0; i < 4; ++i) to.col(i) = pose * Vector3d(from.col(i));
  const Eigen::Matrix4d motion = rigidMotion(from, to);
  EXPECT_LT((motion.topLeftCorner<3, 3>() - pose.orientation.toRotationMatrix()).norm(), kRounding);
  EXPECT_LT((motion.topRightCorner<3, 1>() - pose.position_m).norm(), kRounding);
  mirrored = from;
  mirrored.row(2) *= -1;
  const Matrix3d turn = rigidMotion(from, mirrored).topLeftCorner<3, 3>();
  EXPECT_NEAR(turn.col(0).cross(turn.col(1)).dot(turn.col(2)), 1, kRounding);
}

TEST(Decompositions, PrincipalAxesAreThoseThatTheMatrixWasMadeOf) {
  const Matrix3d axes = Quaterniond(0.5, -0.4, 0.7, 0.1).normalized().toRotationMatrix();
  const Vector3d values(0.25, 1, 3);
  const Matrix3d matrix = axes * values.asDiagonal() * axes.transpose();
  for (const PrincipalAxes& found : {principalAxes(matrix), principalAxesDirect(matrix)}) {
    EXPECT_LT((found.values - values).norm(), 10 * kRounding);
    EXPECT_LT((found.axes * found.values.asDiagonal() * found.axes.transpose() - matrix).norm(), 10 * kRounding);
  }
  EXPECT_EQ(principalValues(matrix), principalAxes(matrix).values);
}

}  // namespace
}  // namespace viscera::test
