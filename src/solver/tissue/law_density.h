// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "layout/law.h"

namespace viscera {

/// Returns the shear energy of the law over mu/2: (exp(b x) - 1) / b, continued linearly from b x = kMostExponent; x
/// without stiffening.
template <class T>
T lawShear(const T& x, double stiffening) {
  using std::exp;
  if (stiffening == 0) return x;
  const double most = static_cast<double>(layout::kMostExponent);
  if (stiffening * x <= most) return (exp(stiffening * x) - 1.0) / stiffening;
  return (std::exp(most) * (1.0 + stiffening * x - most) - 1.0) / stiffening;
}

/// Returns W of the neo-Hookean law over mu (physics.md 1): 1/2 (J^(-2/3) |F|^2 - 3) + K/(4 mu) (J^2 - 1 - 2 ln J).
/// Below kLeastVolume 1/J is constant and J^(-2/3) levels off; the stress is continuous in both.
template <class T>
T lawDensity(const Eigen::Matrix<T, 3, 3>& f, double bulk_over_mu, double stiffening) {
  using std::log;
  using std::pow;
  const double kLeast = static_cast<double>(layout::kLeastVolume);
  const T j = f.col(0).dot(f.col(1).cross(f.col(2))), size = f.squaredNorm();
  if (j >= kLeast)
    return 0.5 * lawShear<T>(pow(j, -2.0 / 3) * size - 3.0, stiffening) +
           0.25 * bulk_over_mu * (j * j - 1.0 - 2.0 * log(j));
  const T phi = std::pow(kLeast, -2.0 / 3) * (1.0 + 2.0 / 3 * (kLeast - j) / (2 * kLeast - j));
  const T logarithm = std::log(kLeast) + (j - kLeast) / kLeast;
  return 0.5 * lawShear<T>(phi * size - 3.0, stiffening) + 0.25 * bulk_over_mu * (j * j - 1.0 - 2.0 * logarithm);
}

}  // namespace viscera
