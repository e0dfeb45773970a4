// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// The energy of cells by moments as physics.md 1 has it: tensors, written out.
#include "solver/reference/moment_energy.h"

#include <cmath>
#include <unsupported/Eigen/AutoDiff>

#include "layout/moments.h"
#include "solver/reference/law_energy.h"

namespace viscera {

namespace {

using layout::kCrushed, layout::kCrushing, layout::kFadeBend, layout::kFadeFull, layout::kFadeNone,
    layout::kFadeStrain2, layout::kMostCrushed;

template <class T>
using Tensor = Eigen::Matrix<T, 3, 3>;
template <class T>
using Vector = Eigen::Matrix<T, 3, 1>;

/// Full contraction of two symmetric tensors.
template <class A, class B>
auto contract(const A& a, const B& b) {
  return a.cwiseProduct(b).sum();
}

/// lambda tr(e) 1 + 2 mu e, over mu.
template <class T>
Tensor<T> stressOf(const Tensor<T>& strain, double lambda_over_mu) {
  const T spherical = lambda_over_mu * strain.trace();
  Tensor<T> out = 2.0 * strain;
  for (int i = 0; i < 3; ++i) out(i, i) += spherical;
  return out;
}

/// The gradient of strain along axis n: the plane across it bends in both directions and twists, and may thin.
/// @param s  s(m, l) = direction of edge m . H_l
template <class T>
Tensor<T> strainGradient(const Tensor<T>& s, int n, double nu) {
  const int a = (n + 1) % 3, b = (n + 2) % 3;
  Tensor<T> out;
  out.setZero();
  out(a, a) = s(a, b);  // a . H of n and a, which is that of the third axis
  out(b, b) = s(b, a);
  out(n, n) = -nu / (1 - nu) * (out(a, a) + out(b, b));
  out(a, b) = out(b, a) = 0.5 * (s(a, a) + s(b, b));
  return out;
}

/// The same in a thin wall. @param missing  second differences of displacement: along each edge, by axis
template <class T>
Tensor<T> strainGradient(const Tensor<T>& s, const Tensor<T>& missing, int n) {
  const auto derivative = [&](int i, int j, int k) { return j == k ? missing(i, j) : s(i, 3 - j - k); };
  Tensor<T> out;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out(i, j) = 0.5 * (derivative(i, j, n) + derivative(j, i, n));
  }
  return out;
}

/// What the springs of a full cell put into hourglass motions, over mu h^3.
template <class T>
T springsOf(const Tensor<T>& s) {
  T sum = s.squaredNorm() + s.trace() * s.trace();
  for (int n = 0; n < 3; ++n) {
    const T pair = s(n, (n + 1) % 3) + s((n + 1) % 3, n);
    sum += pair * pair;
  }
  return sum / 8.0;
}

/// 1 where an edge is as long as at rest, falling to 0 as it is squeezed.
template <class T>
T fadeOf(const T& length) {
  if (length >= kFadeFull) return T(1.0);
  if (length <= kFadeNone) return T(0.0);
  const T t = (length - kFadeNone) / (kFadeFull - kFadeNone);
  return t * t * (3.0 - 2.0 * t);
}

/// What the cell has where its three edges at a corner span less than kCrushed, summed over corners; over mu h^3.
template <class T>
T crushedOf(const Eigen::Matrix<T, 21, 1>& motion) {
  T sum(0.0);
  for (int corner = 0; corner < 8; ++corner) {
    const std::array<double, 3> side = {corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0};
    Tensor<T> edges;
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      const double sb = side[static_cast<size_t>(b)], sc = side[static_cast<size_t>(c)];
      // An edge along a at (b, c): hourglass motions are numbered by the axis that they leave out.
      edges.col(a) = motion.template segment<3>(3 * a) + 0.5 * sb * motion.template segment<3>(9 + 3 * c) +
                     0.5 * sc * motion.template segment<3>(9 + 3 * b) +
                     std::sqrt(0.5) * sb * sc * motion.template segment<3>(18);
      edges(a, a) += 1.0;
    }
    const T volume = edges.col(0).dot(edges.col(1).cross(edges.col(2))), lacks = kCrushed - volume;
    if (lacks <= 0.0) continue;
    sum += lacks < kMostCrushed ? T(0.5 * lacks * lacks) : T(kMostCrushed * (lacks - 0.5 * kMostCrushed));
  }
  return kCrushing / 8.0 * sum;
}

template <class T>
T bendingOf(const MomentCell& cell, const Eigen::Matrix<T, 21, 1>& motion) {
  using std::sqrt;
  const double ratio = cell.bulk_j / cell.rigidity_j, lambda = 1 + ratio, nu = lambda / (2 * (lambda + 1));
  Tensor<T> directions, hourglass, strain;
  T fade(1.0);
  for (int a = 0; a < 3; ++a) {
    Vector<T> edge = motion.template segment<3>(3 * a);
    edge[a] += 1.0;
    if (edge.squaredNorm() <= kFadeNone * kFadeNone) return T(0.0);  // it may have no direction
    const T length = sqrt(edge.squaredNorm()), growth = length - 1.0;
    directions.col(a) = edge / length;
    hourglass.col(a) = motion.template segment<3>(9 + 3 * a);
    strain(a, a) = growth / (1.0 + growth * growth / kFadeStrain2);
    fade *= fadeOf<T>(length);
  }
  const Vector<T> alternating = motion.template segment<3>(18);
  const Tensor<T> s = directions.transpose() * hourglass;
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    strain(a, b) = strain(b, a) = 0.5 * directions.col(a).dot(directions.col(b));
  }
  std::array<Tensor<T>, 3> gradients;
  if (cell.missing) {
    Tensor<T> missing;
    for (int i = 0; i < 9; ++i) {
      T sum(0.0);
      for (int j = 0; j < 9; ++j) sum += (*cell.missing)(i, j) * s(j / 3, j % 3);
      missing(i / 3, i % 3) = sum;
    }
    for (int n = 0; n < 3; ++n) gradients[static_cast<size_t>(n)] = strainGradient<T>(s, missing, n);
  } else {
    for (int n = 0; n < 3; ++n) gradients[static_cast<size_t>(n)] = strainGradient<T>(s, n, nu);
  }
  T energy(0.0);
  for (int n = 0; n < 3; ++n) {
    const Tensor<T> stress = stressOf<T>(gradients[static_cast<size_t>(n)], lambda);
    energy += cell.fill.first[n] * contract(stress, strain);
    for (int j = 0; j < 3; ++j)
      energy += 0.5 * cell.fill.second(n, j) * contract(stress, gradients[static_cast<size_t>(j)]);
  }
  energy -= springsOf<T>(s);
  energy += 0.5 * (5.0 / 18 - 0.5) * alternating.squaredNorm();
  const T bent = s.squaredNorm() / kFadeBend;
  return fade / (1.0 + bent * bent) * energy;
}

template <class T>
T energyOf(const MomentCell& cell, const Eigen::Matrix<T, 21, 1>& motion) {
  if (cell.obeys_law)
    return cell.rigidity_j * lawEnergy<T>(cell.bulk_j / cell.rigidity_j, cell.stiffening, cell.fill, motion);
  return cell.rigidity_j * (bendingOf<T>(cell, motion) + crushedOf<T>(motion));
}

}  // namespace

Eigen::Matrix<double, 7, 1> motionOfCorner(size_t corner, double spacing_m) {
  const double x = corner & 1 ? 1 : -1, y = corner & 2 ? 1 : -1, z = corner & 4 ? 1 : -1;
  Eigen::Matrix<double, 7, 1> out;
  out << x / 4, y / 4, z / 4, y * z / 2, z * x / 2, x * y / 2, x * y * z / std::sqrt(8.0);
  return out / spacing_m;
}

CellMotion cellMotion(const std::array<Vector3d, 8>& u_m, double spacing_m) {
  CellMotion out = CellMotion::Zero();
  for (size_t c = 0; c < 8; ++c) {
    const Eigen::Matrix<double, 7, 1> of_corner = motionOfCorner(c, spacing_m);
    for (int i = 0; i < 7; ++i) out.segment<3>(3 * i) += of_corner[i] * u_m[c];
  }
  return out;
}

double momentEnergy(const MomentCell& cell, const CellMotion& motion) {
  return cell.rigidity_j == 0 ? 0 : energyOf<double>(cell, motion);
}

CellMotion momentGradient(const MomentCell& cell, const CellMotion& motion) {
  if (cell.rigidity_j == 0) return CellMotion::Zero();
  using Dual = Eigen::AutoDiffScalar<CellMotion>;
  Eigen::Matrix<Dual, 21, 1> dual;
  for (int i = 0; i < 21; ++i) dual[i] = Dual(motion[i], 21, i);
  return energyOf<Dual>(cell, dual).derivatives();
}

Eigen::Matrix<double, 21, 21> momentCurvature(const MomentCell& cell, const CellMotion& motion) {
  constexpr double kStep = 1e-6;  // of the spacing: halves the digits of the gradient
  Eigen::Matrix<double, 21, 21> out;
  for (int i = 0; i < 21; ++i) {
    CellMotion up = motion, down = motion;
    up[i] += kStep;
    down[i] -= kStep;
    out.col(i) = (momentGradient(cell, up) - momentGradient(cell, down)) / (2 * kStep);
  }
  return 0.5 * (out + out.transpose());
}

}  // namespace viscera
