// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/math/types.h"

namespace viscera {

// Eigen's decompositions as plain functions. Each takes seconds to compile, so decompositions.cpp alone compiles it.

/// Returns the shortest rotation that turns the direction of `from` into that of `to`; any of them if they are
/// opposite.
Quaterniond rotationBetween(const Vector3d& from, const Vector3d& to);

/// Returns the rigid motion [4 x 4, homogeneous] that moves the columns of `from` [3 x n] to those of `to` [3 x n] with
/// the least squares of distances (Umeyama, PAMI 1991, without scale).
Eigen::Matrix4d rigidMotion(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to);

/// Returns the rotation R that is nearest to `matrix`, with the largest trace of R^T `matrix` (Kabsch, Acta Cryst. A32,
/// 1976).
Matrix3d nearestRotation(const Matrix3d& matrix);

/// Eigenvalues of a symmetric matrix in ascending order, and its unit eigenvectors as columns.
struct PrincipalAxes {
  Vector3d values;
  Matrix3d axes;
};
/// Returns eigenvalues and eigenvectors of a symmetric matrix. Reads its lower triangle.
PrincipalAxes principalAxes(const Matrix3d& symmetric);
/// Returns the same without iterations, from the roots of the cubic: faster, and less exact for close eigenvalues.
PrincipalAxes principalAxesDirect(const Matrix3d& symmetric);
/// Returns the eigenvalues of a symmetric matrix in ascending order.
Vector3d principalValues(const Matrix3d& symmetric);

}  // namespace viscera
