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

/// Returns the energy of two layers at a mean gradient over the mean shear modulus. The jump minimizes the energy, so
/// the derivatives are those at a fixed jump.
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

/// Variation of strain within a cell: its gradients along the cell's axes, and G and `plain` of F* = F (1 + G) + plain.
template <class T>
struct LawVariation {
  Eigen::Matrix<T, 3, 3> gradients[3], g, plain;
};
/// Computes this variation.
/// @tparam N  as for lawEnergy()
/// @param s  hourglass motions in the frame, by columns
/// @param to_frame  J F^-1 over J, or over kLeastVolume below it
template <class T, int N>
LawVariation<T> lawVariation(double poisson, const LawCell& cell, const Eigen::Matrix<T, 3, 3>& s,
                             const Eigen::Matrix<T, 3, 3>& to_frame, const Eigen::Matrix<T, N, 1>& motion) {
  const Vector3d& c = cell.fill.first;
  const Eigen::Matrix3d& moments = cell.fill.second;
  LawVariation<T> out;
  out.plain.setZero();
  for (int n = 0; n < 3; ++n) {
    const int a = (n + 1) % 3, b = (n + 2) % 3;
    // Second derivatives along n, which the corners do not show. A plate that bends thins without shear.
    Eigen::Matrix<T, 3, 1> own;
    own(n) = -poisson * (s(a, b) + s(b, a));
    own(a) = -s(n, b);
    own(b) = -s(n, a);
    if constexpr (N > 21) {
      const Eigen::Matrix<T, 3, 1> by_rows = to_frame * motion.template segment<3>(21 + 3 * n);
      own += cell.wall.rows[n] * (by_rows - own);
      for (const int l : {a, b}) {
        const Eigen::Matrix<T, 3, 1> varies = motion.template segment<3>(30 + 3 * (2 * n + (l == a ? 0 : 1)));
        out.plain.col(l) += cell.wall.variation * 0.5 * (moments(n, n) - 0.25) * varies;
        out.plain.col(n) += cell.wall.variation * moments(n, l) * varies;
      }
    }
    Eigen::Matrix<T, 3, 3>& of_n = out.gradients[n];
    of_n(a, a) = s(a, b);
    of_n(b, b) = s(b, a);
    of_n(n, n) = own(n);
    of_n(a, b) = of_n(b, a) = 0.5 * (s(a, a) + s(b, b));
    of_n(a, n) = of_n(n, a) = 0.5 * (own(a) + s(n, b));
    of_n(b, n) = of_n(n, b) = 0.5 * (own(b) + s(n, a));
    out.g.col(n) = c[a] * s.col(b) + c[b] * s.col(a) + c[n] * own;
  }
  return out;
}

/// Returns the energy of a cell of the neo-Hookean law over rigidity (physics.md 1, Law and Thin walls).
/// @tparam N  21, or 48 for cells in thin walls
/// @param ratio  lambda / mu - 1
/// @param cell  all but its moduli
/// @param motion  mean edges minus their rest value, hourglass motions, alternating motion, over h; in thin walls also
/// second derivatives from rows, and their variation (law_cell.h)
template <class T, int N>
T lawEnergy(double ratio, const LawCell& cell, const Eigen::Matrix<T, N, 1>& motion) {
  using Tensor = Eigen::Matrix<T, 3, 3>;
  const double lambda = 1 + ratio;
  const Eigen::Matrix3d about = cell.fill.second - cell.fill.first * cell.fill.first.transpose();
  Tensor f, h, cofactors;
  for (int a = 0; a < 3; ++a) {
    f.col(a) = motion.template segment<3>(3 * a);
    f(a, a) += 1.0;
    h.col(a) = motion.template segment<3>(9 + 3 * a);
  }
  for (int a = 0; a < 3; ++a) cofactors.col(a) = f.col((a + 1) % 3).cross(f.col((a + 2) % 3));
  const T j = f.col(0).dot(cofactors.col(0));
  const T least = j < static_cast<double>(layout::kLeastVolume) ? T(static_cast<double>(layout::kLeastVolume)) : j;
  const Tensor to_frame = cofactors.transpose() / least, s = to_frame * h;
  const LawVariation<T> varies = lawVariation<T, N>(lambda / (lambda + 2), cell, s, to_frame, motion);
  const Tensor at_centroid = f + f * varies.g + varies.plain;
  T energy = cell.laminate.exists() ? laminateDensity<T>(cell.laminate, at_centroid, cell.stiffening)
                                    : lawDensity<T>(at_centroid, lambda + 2.0 / 3, cell.stiffening);
  const Tensor right = at_centroid.transpose() * at_centroid - Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) energy += 0.5 * cell.prestress(i, k) * right(i, k);
  const double relieved = cell.wall.across * (1 - static_cast<double>(layout::kRowStressAcross)) / (lambda + 2);
  const auto across = [&](const Tensor& gradient) -> T {
    const Eigen::Matrix<T, 3, 1> along = gradient * cell.wall.normal;
    return lambda * gradient.trace() + 2.0 * along.dot(cell.wall.normal.template cast<T>());
  };
  for (int n = 0; n < 3; ++n) {
    for (int k = 0; k < 3; ++k) {
      const Tensor &of_n = varies.gradients[n], &of_k = varies.gradients[k];
      T product = 0.5 * lambda * of_n.trace() * of_k.trace() + of_n.cwiseProduct(of_k).sum();
      if (N > 21 && relieved > 0) product -= 0.5 * relieved * across(of_n) * across(of_k);
      energy += about(n, k) * product;
    }
  }
  const Eigen::Matrix<T, 3, 1> alternating = motion.template segment<3>(18);
  return energy + 0.5 * (5.0 / 18) * alternating.squaredNorm();
}

}  // namespace viscera
