// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "layout/law.h"
#include "solver/reference/law_cell.h"
#include "solver/tissue/law_density.h"
#include "solver/tissue/law_laminate.h"

namespace viscera {

/// Returns the value of a number that may carry derivatives.
inline double valueOf(double x) {
  return x;
}
template <class T>
double valueOf(const T& dual) {
  return dual.value();
}

/// Returns the energy of two layers at a mean gradient over the mean shear modulus. Their jump is at its minimum, so
/// that the energy's derivatives are those at that jump held.
template <class T>
T laminateDensity(const LawLaminate& laminate, const Eigen::Matrix<T, 3, 3>& f, double stiffening) {
  Eigen::Matrix3d values;
  for (int i = 0; i < 9; ++i) values(i) = valueOf(f(i));
  const Vector3d a = laminateJump(laminate, values, stiffening);
  T energy(0.0);
  for (const LawLayer& layer : laminate.layers) {
    const Eigen::Matrix3d by_jump = layer.jump * a * laminate.normal.transpose();
    Eigen::Matrix<T, 3, 3> of_layer = f;
    for (int i = 0; i < 9; ++i) of_layer(i) += by_jump(i);
    energy += layer.weight * lawDensity<T>(of_layer, layer.bulk_over_mu, stiffening);
  }
  return energy;
}

/// Returns the energy of a cell of the neo-Hookean law over rigidity (physics.md 1, Law and Thin walls).
/// @tparam N  21, or 48 for cells in thin walls
/// @param ratio  lambda / mu - 1   @param cell  all but its moduli
/// @param motion  mean edges less their rest value, hourglass motions, alternating motion, over h; in thin walls second
/// derivatives by rows, and their variation (law_cell.h)
template <class T, int N>
T lawEnergy(double ratio, const LawCell& cell, const Eigen::Matrix<T, N, 1>& motion) {
  using Tensor = Eigen::Matrix<T, 3, 3>;
  constexpr bool kWall = N > 21;
  const double lambda = 1 + ratio, poisson = lambda / (lambda + 2);
  const Vector3d& c = cell.fill.first;
  const Eigen::Matrix3d& moments = cell.fill.second;
  const Eigen::Matrix3d about = moments - c * c.transpose();
  Tensor f, h, cofactors;
  for (int a = 0; a < 3; ++a) {
    f.col(a) = motion.template segment<3>(3 * a);
    f(a, a) += 1.0;
    h.col(a) = motion.template segment<3>(9 + 3 * a);
  }
  for (int a = 0; a < 3; ++a) cofactors.col(a) = f.col((a + 1) % 3).cross(f.col((a + 2) % 3));
  const T j = f.col(0).dot(cofactors.col(0));
  const T least = j < static_cast<double>(layout::kLeastVolume) ? T(static_cast<double>(layout::kLeastVolume)) : j;
  const Tensor s = cofactors.transpose() * h / least;  // s(a, l): of H_l along the frame's axis a
  // Second derivatives by pairs of axes that the corners do not show: a plate that bends thins, and does not shear.
  Tensor gradients[3], g, plain;
  plain.setZero();
  for (int n = 0; n < 3; ++n) {
    const int a = (n + 1) % 3, b = (n + 2) % 3;
    Eigen::Matrix<T, 3, 1> own;  // second derivative along n, of its own axis twice
    own(n) = -poisson * (s(a, b) + s(b, a));
    own(a) = -s(n, b);
    own(b) = -s(n, a);
    if constexpr (kWall) {
      const Eigen::Matrix<T, 3, 1> by_rows = cofactors.transpose() * motion.template segment<3>(21 + 3 * n) / least;
      own += cell.wall.rows[n] * (by_rows - own);
      for (const int l : {a, b}) {
        const Eigen::Matrix<T, 3, 1> varies = motion.template segment<3>(30 + 3 * (2 * n + (l == a ? 0 : 1)));
        plain.col(l) += cell.wall.variation * 0.5 * (moments(n, n) - 0.25) * varies;
        plain.col(n) += cell.wall.variation * moments(n, l) * varies;
      }
    }
    Tensor& of_n = gradients[n];
    of_n(a, a) = s(a, b);
    of_n(b, b) = s(b, a);
    of_n(n, n) = own(n);
    of_n(a, b) = of_n(b, a) = 0.5 * (s(a, a) + s(b, b));
    of_n(a, n) = of_n(n, a) = 0.5 * (own(a) + s(n, b));
    of_n(b, n) = of_n(n, b) = 0.5 * (own(b) + s(n, a));
    g.col(n) = c[a] * s.col(b) + c[b] * s.col(a) + c[n] * own;
  }
  const Tensor at_centroid = f + f * g + plain;
  T energy = cell.laminate.exists() ? laminateDensity<T>(cell.laminate, at_centroid, cell.stiffening)
                                    : lawDensity<T>(at_centroid, lambda + 2.0 / 3, cell.stiffening);
  const Tensor right = at_centroid.transpose() * at_centroid - Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) energy += 0.5 * cell.prestress(i, k) * right(i, k);
  const double relieved =
      kWall ? cell.wall.across * (1 - static_cast<double>(layout::kRowStressAcross)) / (lambda + 2) : 0;
  const auto across = [&](const Tensor& gradient) -> T {
    const Eigen::Matrix<T, 3, 1> along = gradient * cell.wall.normal;
    return lambda * gradient.trace() + 2.0 * along.dot(cell.wall.normal.template cast<T>());
  };
  for (int n = 0; n < 3; ++n) {
    for (int k = 0; k < 3; ++k) {
      const T traces = gradients[n].trace() * gradients[k].trace();
      T product = 0.5 * lambda * traces + gradients[n].cwiseProduct(gradients[k]).sum();
      if (relieved > 0) product -= 0.5 * relieved * across(gradients[n]) * across(gradients[k]);
      energy += about(n, k) * product;
    }
  }
  const Eigen::Matrix<T, 3, 1> alternating = motion.template segment<3>(18);
  return energy + 0.5 * (5.0 / 18) * alternating.squaredNorm();
}

}  // namespace viscera
