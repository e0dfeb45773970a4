// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tissue/law_laminate.h"

#include <Eigen/LU>
#include <unsupported/Eigen/AutoDiff>

#include "solver/tissue/law_density.h"

namespace viscera {

namespace {

constexpr int kMostJumpSteps = 60;        // Newton needs 3 to 8
constexpr double kJumpDifference = 1e-6;  // step of a gradient's difference quotient: half of the digits
constexpr double kLeastStep = 1e-15;      // least step of a, which is a strain

/// Energy over mu, and its gradient by a.
struct JumpEnergy {
  double value;
  Vector3d gradient;
};

JumpEnergy jumpEnergy(const LawLaminate& laminate, const Eigen::Matrix3d& f, double stiffening, const Vector3d& a) {
  using Dual = Eigen::AutoDiffScalar<Vector3d>;
  JumpEnergy out{0, Vector3d::Zero()};
  for (const LawLayer& layer : laminate.layers) {
    Eigen::Matrix<Dual, 3, 3> of_layer;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        const double by_a = layer.jump * laminate.normal[c];
        of_layer(r, c) = Dual(f(r, c) + by_a * a[r], Vector3d(by_a * Vector3d::Unit(r)));
      }
    }
    const Dual energy = lawDensity<Dual>(of_layer, layer.bulk_over_mu, stiffening);
    out.value += layer.weight * energy.value();
    out.gradient += layer.weight * energy.derivatives();
  }
  return out;
}

}  // namespace

LawLaminate lawLaminateOf(const CellLaminate& cell) {
  const double of_a = cell.share_a * cell.rigidity_a;
  return {cell.normal, {{of_a, 1 - cell.share_a, cell.bulk_a}, {1 - of_a, -cell.share_a, cell.bulk_b}}};
}

Vector3d laminateJump(const LawLaminate& laminate, const Eigen::Matrix3d& f, double stiffening) {
  Vector3d a = Vector3d::Zero();
  JumpEnergy now = jumpEnergy(laminate, f, stiffening, a);
  for (int step = 0; step < kMostJumpSteps; ++step) {
    Eigen::Matrix3d curvature;
    for (int i = 0; i < 3; ++i) {
      const Vector3d by = kJumpDifference * Vector3d::Unit(i);
      curvature.col(i) = (jumpEnergy(laminate, f, stiffening, a + by).gradient -
                          jumpEnergy(laminate, f, stiffening, a - by).gradient) /
                         (2 * kJumpDifference);
    }
    Vector3d direction = -curvature.partialPivLu().solve(now.gradient);
    if (!(direction.dot(now.gradient) < 0)) direction = -now.gradient;
    // Where energies differ only by rounding, the gradient decides.
    const auto isBetter = [&](const JumpEnergy& next) {
      return next.value < now.value || next.gradient.norm() < 0.5 * now.gradient.norm();
    };
    JumpEnergy next = jumpEnergy(laminate, f, stiffening, a + direction);
    while (!isBetter(next) && direction.norm() > kLeastStep) {
      direction *= 0.5;
      next = jumpEnergy(laminate, f, stiffening, a + direction);
    }
    if (direction.norm() <= kLeastStep) break;
    a += direction;
    now = next;
  }
  return a;
}

}  // namespace viscera
