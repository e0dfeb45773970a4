// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "layout/law.h"
#include "solver/tissue/law_density.h"
#include "solver/tissue/law_laminate.h"
#include "viscera/model/shape/solid.h"

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

/// Returns the energy of a cell of the neo-Hookean law over rigidity (physics.md 1, Law).
/// @param ratio  lambda / mu - 1   @param stiffening  b of lawShear()   @param fill  moments of the cell's tissue over
/// its share   @param laminate  the cell's two materials, if it has two
/// @param prestress  S over mu: its stress at rest has the energy S : (F^T F - 1) / 2
/// @param motion  mean edges less their rest value, hourglass motions, alternating motion, over h (law_cell.h)
template <class T>
T lawEnergy(double ratio, double stiffening, const CellFill& fill, const LawLaminate& laminate,
            const Eigen::Matrix3d& prestress, const Eigen::Matrix<T, 21, 1>& motion) {
  using Tensor = Eigen::Matrix<T, 3, 3>;
  const double lambda = 1 + ratio, poisson = lambda / (lambda + 2);
  const Vector3d& c = fill.first;
  const Eigen::Matrix3d about = fill.second - c * c.transpose();
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
  Tensor gradients[3], g;
  for (int n = 0; n < 3; ++n) {
    const int a = (n + 1) % 3, b = (n + 2) % 3;
    Tensor& of_n = gradients[n];
    of_n.setZero();
    of_n(a, a) = s(a, b);
    of_n(b, b) = s(b, a);
    of_n(n, n) = -poisson * (of_n(a, a) + of_n(b, b));
    of_n(a, b) = of_n(b, a) = 0.5 * (s(a, a) + s(b, b));
    g.col(n) = c[a] * s.col(b) + c[b] * s.col(a);
    g(n, n) -= poisson * c[n] * (s(a, b) + s(b, a));
    g(a, n) -= c[n] * s(n, b);
    g(b, n) -= c[n] * s(n, a);
  }
  const Tensor at_centroid = f + f * g;
  T energy = laminate.exists() ? laminateDensity<T>(laminate, at_centroid, stiffening)
                               : lawDensity<T>(at_centroid, lambda + 2.0 / 3, stiffening);
  const Tensor right = at_centroid.transpose() * at_centroid - Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) energy += 0.5 * prestress(i, k) * right(i, k);
  for (int n = 0; n < 3; ++n) {
    for (int k = 0; k < 3; ++k) {
      const T traces = gradients[n].trace() * gradients[k].trace();
      energy += about(n, k) * (0.5 * lambda * traces + gradients[n].cwiseProduct(gradients[k]).sum());
    }
  }
  const Eigen::Matrix<T, 3, 1> alternating = motion.template segment<3>(18);
  return energy + 0.5 * (5.0 / 18) * alternating.squaredNorm();
}

}  // namespace viscera
