// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "math/decompositions.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace viscera {

namespace {

constexpr double kOpposite = 1e-12 - 1;  // cosine below which rounding loses the axis

using AxesSolver = Eigen::SelfAdjointEigenSolver<Matrix3d>;

}  // namespace

// Avoids Eigen's FromTwoVectors(), which takes a singular value decomposition for opposite vectors.
Quaterniond rotationBetween(const Vector3d& from, const Vector3d& to) {
  const Vector3d a = from.normalized(), b = to.normalized();
  const double cosine = b.dot(a);
  Quaterniond out;
  if (cosine < kOpposite) {
    out.w() = 0;
    out.vec() = a.unitOrthogonal();
    return out;
  }
  const double twice_w = std::sqrt((1 + cosine) * 2);
  out.vec() = a.cross(b) * (1 / twice_w);
  out.w() = twice_w * 0.5;
  return out;
}

Matrix3d nearestRotation(const Matrix3d& matrix) {
  const Eigen::JacobiSVD<Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const bool mirrored = svd.matrixU().determinant() * svd.matrixV().determinant() < 0;
  return svd.matrixU() * Vector3d(1, 1, mirrored ? -1 : 1).asDiagonal() * svd.matrixV().transpose();
}

Eigen::Matrix4d rigidMotion(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  const Vector3d from_mean = from.rowwise().mean(), to_mean = to.rowwise().mean();
  Matrix3d spread = Matrix3d::Zero();
  for (Eigen::Index i = 0; i < from.cols(); ++i)
    spread += (to.col(i) - to_mean) * (from.col(i) - from_mean).transpose();
  const Matrix3d turn = nearestRotation(spread);
  Eigen::Matrix4d motion = Eigen::Matrix4d::Identity();
  motion.topLeftCorner<3, 3>() = turn;
  motion.topRightCorner<3, 1>() = to_mean - turn * from_mean;
  return motion;
}

PrincipalAxes principalAxes(const Matrix3d& symmetric) {
  const AxesSolver solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

PrincipalAxes principalAxesDirect(const Matrix3d& symmetric) {
  AxesSolver solver;
  solver.computeDirect(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Vector3d principalValues(const Matrix3d& symmetric) {
  return AxesSolver(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace viscera
