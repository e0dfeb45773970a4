// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/specimens/revolution.h"

#include <Eigen/SparseCholesky>
#include <array>
#include <cmath>

namespace viscera::bench {

namespace {

using Matrix6x27 = Eigen::Matrix<double, 6, 27>;
using Vector27 = Eigen::Matrix<double, 27, 1>;
using Vector9 = Eigen::Matrix<double, 9, 1>;

constexpr double kOnAxis = 1e-9;  ///< [m]
const std::array<double, 3> kGauss = {-std::sqrt(0.6), 0, std::sqrt(0.6)};
constexpr std::array<double, 3> kWeights = {5.0 / 9, 8.0 / 9, 5.0 / 9};

/// Quadratic shape functions on -1, 0, 1, and their derivatives.
Vector3d shape(double x) {
  return {x * (x - 1) / 2, 1 - x * x, x * (x + 1) / 2};
}
Vector3d slope(double x) {
  return {x - 0.5, -2 * x, x + 0.5};
}
Vector9 outer(const Vector3d& a, const Vector3d& b) {
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> m = a * b.transpose();
  return Eigen::Map<const Vector9>(m.data());
}

/// A grid of elements with nine nodes each and three displacements per node: u_r, u_theta, u_z.
class Mesh {
 public:
  explicit Mesh(const Revolution& body) : body_(body), rows_(2 * body.across + 1), columns_(2 * body.along + 1) {
    for (int i = 0; i < rows_; ++i) {
      for (int j = 0; j < columns_; ++j) {
        positions_.push_back(
            body.section(static_cast<double>(i) / (rows_ - 1), static_cast<double>(j) / (columns_ - 1)));
      }
    }
    const double nu = body.poisson_ratio, young = body.young_modulus_pa, mu = young / (2 * (1 + nu));
    elasticity_.diagonal() << 2 * mu, 2 * mu, 2 * mu, mu, mu, mu;
    elasticity_.topLeftCorner<3, 3>().array() += young * nu / ((1 + nu) * (1 - 2 * nu));
  }

  double compliance() {
    for (int i = 0; i < body_.across; ++i) {
      for (int j = 0; j < body_.along; ++j) addElement(i, j);
    }
    pin();
    Eigen::SparseMatrix<double> k(dofs(), dofs());
    k.setFromTriplets(stiffness_.begin(), stiffness_.end());
    for (int d = 0; d < dofs(); ++d) {
      if (!fixed_[static_cast<size_t>(d)]) continue;
      load_[d] = 0;
      k.coeffRef(d, d) += kHeld * elasticity_(0, 0);
    }
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt(k);
    return load_.dot(ldlt.solve(load_));
  }

 private:
  static constexpr double kHeld = 1e9;  ///< penalty stiffness of a fixed displacement, relative to the material

  int dofs() const { return 3 * static_cast<int>(positions_.size()); }
  void addElement(int i, int j) {
    std::array<int, 9> nodes;
    Vector9 r, z;
    for (int n = 0; n < 9; ++n) {
      nodes[static_cast<size_t>(n)] = (2 * i + n / 3) * columns_ + 2 * j + n % 3;
      const Eigen::Vector2d& at = positions_[static_cast<size_t>(nodes[static_cast<size_t>(n)])];
      r[n] = at.x(), z[n] = at.y();
    }
    Eigen::Matrix<double, 27, 27> k = Eigen::Matrix<double, 27, 27>::Zero();
    Vector27 f = Vector27::Zero();
    for (size_t a = 0; a < 3; ++a) {
      for (size_t b = 0; b < 3; ++b) addPoint(kGauss[a], kGauss[b], kWeights[a] * kWeights[b], r, z, k, f);
    }
    for (int p = 0; p < 27; ++p) {
      const int row = 3 * nodes[static_cast<size_t>(p / 3)] + p % 3;
      load_[row] += f[p];
      for (int q = 0; q < 27; ++q) {
        stiffness_.emplace_back(row, 3 * nodes[static_cast<size_t>(q / 3)] + q % 3, k(p, q));
      }
    }
  }
  /// Adds one Gauss point. @param r, z  of the element's nodes
  void addPoint(double a, double b, double weight, const Vector9& r, const Vector9& z, Eigen::Matrix<double, 27, 27>& k,
                Vector27& f) const {
    const Vector9 n = outer(shape(a), shape(b)), na = outer(slope(a), shape(b)), nb = outer(shape(a), slope(b));
    Eigen::Matrix2d jacobian;
    jacobian << r.dot(na), r.dot(nb), z.dot(na), z.dot(nb);
    const Eigen::Matrix2d inverse = jacobian.inverse();
    const Vector9 by_r = inverse(0, 0) * na + inverse(1, 0) * nb, by_z = inverse(0, 1) * na + inverse(1, 1) * nb;
    const double radius = r.dot(n), waves = body_.waves;
    const Vector9 over_r = n / radius;
    Matrix6x27 strain = Matrix6x27::Zero();  // rr, tt, zz, rz, rt, tz
    for (int m = 0; m < 9; ++m) {
      strain(0, 3 * m) = by_r[m];
      strain(1, 3 * m) = over_r[m];
      strain(1, 3 * m + 1) = waves * over_r[m];
      strain(2, 3 * m + 2) = by_z[m];
      strain(3, 3 * m) = by_z[m];
      strain(3, 3 * m + 2) = by_r[m];
      strain(4, 3 * m) = -waves * over_r[m];
      strain(4, 3 * m + 1) = by_r[m] - over_r[m];
      strain(5, 3 * m + 1) = by_z[m];
      strain(5, 3 * m + 2) = -waves * over_r[m];
    }
    const double around = body_.waves == 0 ? 2 * M_PI : M_PI;  // integral of cos^2
    const double volume = weight * std::abs(jacobian.determinant()) * radius * around;
    k += volume * strain.transpose() * elasticity_ * strain;
    const Vector3d load = body_.load(radius, z.dot(n));
    for (int m = 0; m < 9; ++m) f.segment<3>(3 * m) += volume * n[m] * load;
  }
  /// Applies the regularity conditions on the axis and fixes the rigid motions.
  void pin() {
    const int n = body_.waves;
    fixed_.assign(static_cast<size_t>(dofs()), false);
    size_t low = 0, high = 0;
    for (size_t i = 0; i < positions_.size(); ++i) {
      const Eigen::Vector2d& at = positions_[i];
      if (n == 0) fixed_[3 * i + 1] = true;
      if (at.x() < kOnAxis) {
        if (n != 1) fixed_[3 * i] = fixed_[3 * i + 1] = true;
        if (n > 0) fixed_[3 * i + 2] = true;
      }
      if (at.x() - at.y() > positions_[low].x() - positions_[low].y()) low = i;
      if (at.x() + at.y() > positions_[high].x() + positions_[high].y()) high = i;
    }
    if (n == 0) fixed_[3 * low + 2] = true;
    if (n == 1) fixed_[3 * low] = fixed_[3 * high] = true;
  }

  const Revolution& body_;
  int rows_, columns_;
  std::vector<Eigen::Vector2d> positions_;  ///< [nodes] r, z
  Eigen::Matrix<double, 6, 6> elasticity_ = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<Eigen::Triplet<double>> stiffness_;
  Eigen::VectorXd load_ = Eigen::VectorXd::Zero(3 * (2 * body_.across + 1) * (2 * body_.along + 1));
  std::vector<bool> fixed_;  ///< [dofs]
};

}  // namespace

double continuumCompliance(const Revolution& body) {
  return Mesh(body).compliance();
}

}  // namespace viscera::bench
