// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/pivot.h"

#include "devices/millimetres.h"
#include "math/decompositions.h"

namespace viscera {

Pivot solvePivot(const std::vector<Pose>& poses, const PivotLimits& limits) {
  if (poses.size() < kLeastPivotPoses)
    throw RegistrationError("a pivot calibration needs " + std::to_string(kLeastPivotPoses) +
                            " poses at least, and has " + std::to_string(poses.size()) + "; collect more");
  const auto count = static_cast<double>(poses.size());
  Eigen::Matrix3d mean_turn = Eigen::Matrix3d::Zero();
  Vector3d mean_m = Vector3d::Zero();
  for (const Pose& pose : poses) {
    mean_turn += pose.orientation.toRotationMatrix() / count;
    mean_m += pose.position_m / count;
  }
  // The pivot is the mean of all tips: (R_i - mean R) t = mean p - p_i remains.
  // Normal equations suffice: accepted rotations condition them well.
  Matrix3d squares = Matrix3d::Zero();
  Vector3d right_m = Vector3d::Zero();
  for (const Pose& pose : poses) {
    const Matrix3d turn = pose.orientation.toRotationMatrix() - mean_turn;
    squares += turn.transpose() * turn;
    right_m += turn.transpose() * (mean_m - pose.position_m);
  }
  const PrincipalAxes turned = principalAxes(squares);
  Pivot out;
  out.turned = std::sqrt(std::max(turned.values[0], 0.0) / count);
  if (!(out.turned >= kLeastTurned))
    throw RegistrationError("the device was turned too little, or about only one axis: " + rounded(out.turned, 3) +
                            " m of travel per metre of tip in the direction of least rotation; at least " +
                            rounded(kLeastTurned, 3) +
                            " is needed. Tilt it by 30 degrees to all sides and keep the tip in place");
  out.tip_m = turned.axes * (turned.axes.transpose() * right_m).cwiseQuotient(turned.values);
  out.pivot_m = mean_m + mean_turn * out.tip_m;
  double squares_m2 = 0;
  for (const Pose& pose : poses) squares_m2 += (pose * out.tip_m - out.pivot_m).squaredNorm();
  out.residual_m = std::sqrt(squares_m2 / count);
  if (!(out.residual_m <= limits.residual_m))
    throw RegistrationError("the tip did not stay in place, or the poses are not good enough: residual " +
                            millimetres(out.residual_m) + " mm; at most " + millimetres(limits.residual_m) +
                            " mm is accepted");
  return out;
}

}  // namespace viscera
