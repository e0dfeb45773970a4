// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/bend_matrices.h"

#include <array>

namespace viscera {

namespace {

/// Strain's gradient along an axis, by hourglass motions and second differences.
using Gradient = Eigen::Matrix<double, 6, 18>;

/// Number of the second derivative of u_i along j and k.
int derivative(int i, int j, int k) {
  return j == k ? 9 + 3 * i + j : 3 * i + (3 - j - k);
}

const std::array<Gradient, 3>& gradients() {
  static const std::array<Gradient, 3> kAll = [] {
    std::array<Gradient, 3> out;
    for (int k = 0; k < 3; ++k) {
      Gradient& g = out[static_cast<size_t>(k)];
      g.setZero();
      for (int i = 0; i < 3; ++i) {
        const int a = (i + 1) % 3, b = (i + 2) % 3;
        g(i, derivative(i, i, k)) = 1;
        g(3 + i, derivative(a, b, k)) += 1;
        g(3 + i, derivative(b, a, k)) += 1;
      }
    }
    return out;
  }();
  return kAll;
}

Eigen::Matrix<double, 18, 9> withMissing(const BendMatrix& missing) {
  Eigen::Matrix<double, 18, 9> out;
  out << BendMatrix::Identity(), missing;
  return out;
}

}  // namespace

Eigen::Matrix<double, 6, 6> solidStiffness(double lambda_over_mu) {
  Eigen::Matrix<double, 6, 6> out = Eigen::Matrix<double, 6, 6>::Identity();
  out.topLeftCorner<3, 3>() *= 2;
  out.topLeftCorner<3, 3>().array() += lambda_over_mu;
  return out;
}

Eigen::Matrix<double, 18, 18> gradientStiffness(const Eigen::Matrix3d& second, double lambda_over_mu) {
  const Eigen::Matrix<double, 6, 6> solid = solidStiffness(lambda_over_mu);
  Eigen::Matrix<double, 18, 18> out = Eigen::Matrix<double, 18, 18>::Zero();
  for (size_t j = 0; j < 3; ++j) {
    Gradient stress = Gradient::Zero();
    for (size_t k = 0; k < 3; ++k)
      stress += second(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k)) * gradients()[k];
    out += gradients()[j].transpose() * (solid * stress);
  }
  return out;
}

BendMatrix missingAlone(double lambda_over_mu) {
  const double across = -lambda_over_mu / (lambda_over_mu + 2);  // -nu/(1 - nu)
  BendMatrix out = BendMatrix::Zero();
  for (int n = 0; n < 3; ++n) {
    const int a = (n + 1) % 3, b = (n + 2) % 3;
    out(3 * n + n, 3 * a + b) = out(3 * n + n, 3 * b + a) = across;
    out(3 * a + n, 3 * n + b) = out(3 * b + n, 3 * n + a) = -1;
  }
  return out;
}

CellBending bendingOf(const CellFill& over_share, double lambda_over_mu, const BendMatrix& missing) {
  const Eigen::Matrix<double, 18, 9> all = withMissing(missing);
  Gradient coupled = Gradient::Zero();
  for (size_t n = 0; n < 3; ++n) coupled += over_share.first[static_cast<Eigen::Index>(n)] * gradients()[n];
  return {all.transpose() * gradientStiffness(over_share.second, lambda_over_mu) * all,
          all.transpose() * coupled.transpose() * solidStiffness(lambda_over_mu)};
}

}  // namespace viscera
