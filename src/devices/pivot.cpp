// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/pivot.h"

#include <Eigen/SVD>

#include "devices/millimetres.h"

namespace viscera {

Pivot solvePivot(const std::vector<Pose>& poses, const PivotLimits& limits) {
  if (poses.size() < kLeastPivotPoses)
    throw RegistrationError("a pivot needs " + std::to_string(kLeastPivotPoses) + " poses at least, and has " +
                            std::to_string(poses.size()));
  const auto count = static_cast<double>(poses.size());
  Eigen::Matrix3d mean_turn = Eigen::Matrix3d::Zero();
  Vector3d mean_m = Vector3d::Zero();
  for (const Pose& pose : poses) {
    mean_turn += pose.orientation.toRotationMatrix() / count;
    mean_m += pose.position_m / count;
  }
  // The pivot is the mean of all tips: what is left is (R_i - mean R) t = mean p - p_i.
  const auto rows = static_cast<Eigen::Index>(3 * poses.size());
  Eigen::MatrixX3d turns(rows, 3);
  Eigen::VectorXd travel_m(rows);
  for (size_t i = 0; i < poses.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    turns.middleRows<3>(row) = poses[i].orientation.toRotationMatrix() - mean_turn;
    travel_m.segment<3>(row) = mean_m - poses[i].position_m;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(turns, Eigen::ComputeThinU | Eigen::ComputeThinV);
  Pivot out;
  out.turned = svd.singularValues()[2] / std::sqrt(count);
  if (!(out.turned >= kLeastTurned))
    throw RegistrationError("the device was turned too little, or about one axis only: " + rounded(out.turned, 3) +
                            " m of travel per metre of tip in the direction that was turned least, at least " +
                            rounded(kLeastTurned, 3) +
                            " is needed: tilt it by 30 degrees to all sides, the tip in place");
  out.tip_m = svd.solve(travel_m);
  out.pivot_m = mean_m + mean_turn * out.tip_m;
  out.residual_m = (turns * out.tip_m - travel_m).norm() / std::sqrt(count);
  if (!(out.residual_m <= limits.residual_m))
    throw RegistrationError("the tip did not stay in place, or the poses are not good enough: residual " +
                            millimetres(out.residual_m) + " mm, at most " + millimetres(limits.residual_m) +
                            " mm is accepted");
  return out;
}

}  // namespace viscera
