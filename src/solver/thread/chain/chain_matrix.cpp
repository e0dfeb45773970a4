// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/thread/chain/chain_matrix.h"

namespace viscera {

namespace {

/// Inverse of a symmetric positive matrix by L D L^T: parts of it are a billion times as stiff as others.
Matrix3d inverseOf(const Matrix3d& a) {
  const double first = 1 / a(0, 0), l10 = a(1, 0) * first, l20 = a(2, 0) * first;
  const double second = 1 / (a(1, 1) - l10 * a(1, 0)), below = a(2, 1) - l20 * a(1, 0), l21 = below * second;
  const double third = 1 / (a(2, 2) - l20 * a(2, 0) - l21 * below);
  const double m20 = l10 * l21 - l20;
  Matrix3d out;
  out(2, 2) = third;
  out(1, 2) = out(2, 1) = -l21 * third;
  out(0, 2) = out(2, 0) = m20 * third;
  out(1, 1) = second + l21 * l21 * third;
  out(0, 1) = out(1, 0) = -l10 * second - m20 * l21 * third;
  out(0, 0) = first + l10 * l10 * second + m20 * m20 * third;
  return out;
}

}  // namespace

ChainMatrix::ChainMatrix(size_t nodes) : rows_(nodes) {}

void ChainMatrix::setNode(size_t i, double self, double next, double after) {
  Row& row = rows_[i];
  row.self = self * Matrix3d::Identity();
  row.next.setZero();
  row.next(0, 0) = row.next(1, 1) = row.next(2, 2) = next;
  row.after = after;
}

void ChainMatrix::addLink(size_t i, const Vector3d& along, double across) {
  Row& row = rows_[i];
  row.next.row(3) = along;
  if (across <= 0) return;
  const Matrix3d turned = across * (Matrix3d::Identity() - along * along.transpose());
  row.self += turned;
  rows_[i + 1].self += turned;
  row.next.topRows<3>() -= turned;
}

void ChainMatrix::addPoint(size_t i, double share, double all, const Vector3d& way) {
  addPoint(i, share, all * Matrix3d::Identity() + way * way.transpose());
}

void ChainMatrix::addPoint(size_t i, double share, const Matrix3d& what) {
  rows_[i].self += (1 - share) * (1 - share) * what;
  if (share == 0) return;
  rows_[i + 1].self += share * share * what;
  rows_[i].next.topRows<3>() += share * (1 - share) * what;
}

void ChainMatrix::factor() {
  const size_t n = rows_.size();
  for (size_t i = 0; i < n; ++i) {
    Row& row = rows_[i];
    const Matrix3d a = inverseOf(row.self);
    const Vector3d along = row.next.row(3);
    const Vector3d bent = a * along;
    const double tension = i + 1 < n ? -1 / along.dot(bent) : -1;
    row.back.topLeftCorner<3, 3>() = a + tension * bent * bent.transpose();
    row.back.topRightCorner<3, 1>() = tension * bent;
    row.back.bottomLeftCorner<1, 3>() = tension * bent.transpose();
    row.back(3, 3) = tension;
    if (i + 1 == n) break;
    const Matrix43 low = row.back * row.next;
    rows_[i + 1].self.noalias() -= row.next.transpose() * low;
    if (i + 2 == n) continue;
    rows_[i + 1].next.topRows<3>() -= row.after * low.topRows<3>().transpose();
    rows_[i + 2].self -= row.after * row.after * row.back.topLeftCorner<3, 3>();
  }
}

void ChainMatrix::solve(std::vector<Unknown>& right) const {
  const size_t n = rows_.size();
  const auto joined = [](const Unknown& one) {
    return Eigen::Vector4d(one.place.x(), one.place.y(), one.place.z(), one.tension);
  };
  for (size_t i = 0; i < n; ++i) {
    const Row& row = rows_[i];
    const Eigen::Vector4d x = row.back * joined(right[i]);
    if (i + 1 < n) right[i + 1].place -= row.next.transpose() * x;
    if (i + 2 < n) right[i + 2].place -= row.after * x.head<3>();
    right[i] = {x.head<3>(), x[3]};
  }
  for (size_t i = n - 1; i-- > 0;) {
    const Row& row = rows_[i];
    Eigen::Vector4d known = row.next * right[i + 1].place;
    if (i + 2 < n) known.head<3>() += row.after * right[i + 2].place;
    const Eigen::Vector4d x = joined(right[i]) - row.back * known;
    right[i] = {x.head<3>(), x[3]};
  }
}

}  // namespace viscera
