// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// material.prestress of lattices (docs/physics.md 11). A cell without constraints would take the shape U = 1 - strain.
// The stress S = -U^-1 P(U) at F = 1, with P that of the law, holds it open. S is then balanced in the given shape.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "model/fracture/prestress.h"
#include "model/fracture/prestress_balance.h"
#include "model/scene/structure_rules.h"
#include "viscera/model/body/elasticity.h"

namespace viscera {

namespace {

using Eigen::Matrix3d;
using Field = std::vector<Vector3d>;

/// Returns S over mu that makes U the rest shape (physics.md 1, Prestress). @param strain  1 - U, symmetric
/// @param bulk  K/mu   @param stiffening  b of the law
Matrix3d stressOf(const Matrix3d& strain, double bulk, double stiffening) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(strain);
  const Vector3d u = Vector3d::Ones() - axes.eigenvalues();
  const double j = u.prod(), size = u.squaredNorm(), phi = std::pow(j, -2.0 / 3);
  const double shear = phi * std::exp(stiffening * (phi * size - 3));
  Vector3d stress;
  for (int a = 0; a < 3; ++a)
    stress[a] = -(shear * (u[a] - size / (3 * u[a])) + 0.5 * bulk * (j * j - 1) / u[a]) / u[a];
  return axes.eigenvectors() * stress.asDiagonal() * axes.eigenvectors().transpose();
}

/// Cell with its stress, and the map from displacements of its corners to the gradient at the centroid of its tissue.
struct Cell {
  uint32_t slot;
  std::array<uint32_t, 8> corners;  // slots, x first
  double rigidity_j, lambda;        // mu h^3 times the share [J]; lambda over mu
  Vector3d centroid;
  Matrix3d stress = Matrix3d::Zero();  // over mu
};

double side(size_t corner, int axis) {
  return corner >> axis & 1 ? 1 : -1;
}
/// Returns the product of the signs along the two other axes.
double sides(size_t corner, int axis) {
  return side(corner, (axis + 1) % 3) * side(corner, (axis + 2) % 3);
}

/// Returns the gradient of small displacements at a cell's centroid (law_energy.h: D + G).
Matrix3d gradientOf(const Cell& cell, const Field& u_m, double h) {
  Matrix3d g = Matrix3d::Zero(), s = Matrix3d::Zero();
  const double per_edge = 1 / (4 * h), per_face = 1 / (2 * h);
  const Vector3d& at = cell.centroid;
  const bool full = at.isZero(0);
  for (size_t c = 0; c < 8; ++c) {
    const Vector3d& u = u_m[cell.corners[c]];
    for (int a = 0; a < 3; ++a) {
      g.col(a) += side(c, a) * per_edge * u;
      if (!full) s.col(a) += sides(c, a) * per_face * u;
    }
  }
  const double poisson = cell.lambda / (cell.lambda + 2);
  for (int n = 0; n < 3 && !full; ++n) {
    const int a = (n + 1) % 3, b = (n + 2) % 3;
    g.col(n) += at[a] * s.col(b) + at[b] * s.col(a);
    g(n, n) -= poisson * at[n] * (s(a, b) + s(b, a));
    g(a, n) -= at[n] * s(n, b);
    g(b, n) -= at[n] * s(n, a);
  }
  return g;
}

/// Adds the forces [N] of a stress over mu on a cell's corners; gradientOf() is the adjoint.
void addPull(const Cell& cell, const Matrix3d& stress, double h, Field& forces_n) {
  Matrix3d r = Matrix3d::Zero();
  const double per_edge = 1 / (4 * h), per_face = 1 / (2 * h);
  const double poisson = cell.lambda / (cell.lambda + 2);
  const Vector3d& at = cell.centroid;
  const bool full = at.isZero(0);
  for (int n = 0; n < 3 && !full; ++n) {
    const int a = (n + 1) % 3, b = (n + 2) % 3;
    r.col(b) += at[a] * stress.col(n);
    r.col(a) += at[b] * stress.col(n);
    r(a, b) -= poisson * at[n] * stress(n, n);
    r(b, a) -= poisson * at[n] * stress(n, n);
    r(n, b) -= at[n] * stress(a, n);
    r(n, a) -= at[n] * stress(b, n);
  }
  for (size_t c = 0; c < 8; ++c) {
    Vector3d force = Vector3d::Zero();
    for (int a = 0; a < 3; ++a) {
      const Vector3d along = side(c, a) * per_edge * stress.col(a);
      force += full ? along : Vector3d(along + sides(c, a) * per_face * r.col(a));
    }
    forces_n[cell.corners[c]] -= cell.rigidity_j * force;
  }
}

/// Returns lambda tr(e) 1 + 2 e.
Matrix3d elastic(const Cell& cell, const Matrix3d& gradient) {
  const Matrix3d strain = 0.5 * (gradient + gradient.transpose());
  return cell.lambda * strain.trace() * Matrix3d::Identity() + 2 * strain;
}

class CellBalance : public PrestressBalance {
 public:
  explicit CellBalance(const Body& body) : PrestressBalance(body), h_(body.lattice.spacing_m) {
    readCells();
    ask();
  }

  const std::vector<Cell>& cells() const { return cells_; }

 private:
  void readCells() {
    const Lattice& lattice = body_.lattice;
    const Strengths table = strengths(body_);
    const CellMoments moments = cellMoments(body_);
    for (uint32_t slot = 0; slot < lattice.nodes.size(); ++slot) {
      if (lattice.cell_labels[slot] == 0) continue;
      const uint32_t which = moments.of_cell.empty() ? 0 : moments.of_cell[slot];
      const double rigidity = static_cast<double>(table.rigidity_j[slot]);
      Cell cell{slot, {}, rigidity, 1 + static_cast<double>(table.bulk_j[slot]) / rigidity, Vector3d::Zero()};
      if (which != 0) cell.centroid = moments.fills[which - 1].first / moments.fills[which - 1].share;
      size_t c = 0;
      forEachCorner(lattice, slot, [&](const Vector3i&, uint32_t corner) { cell.corners[c++] = corner; });
      cells_.push_back(cell);
    }
  }

  /// Sets the requested stresses. A cell that shares materials has their mean stress, weighted by their shares.
  void ask() {
    const Lattice& lattice = body_.lattice;
    const std::vector<Elasticity> elasticities = elasticityByLabel(body_);
    const std::vector<Matrix3d> strains = strainsByLabel(body_);
    std::vector<Matrix3d> stresses;
    for (size_t label = 0; label < strains.size(); ++label) {
      const double lambda = 1 + elasticities[label].bulk_j / elasticities[label].rigidity_j;
      stresses.push_back(stressOf(strains[label], lambda + 2.0 / 3, body_.material.stiffening));
    }
    auto shared = lattice.shared.begin();
    for (Cell& cell : cells_) {
      const auto first = shared;
      double sum = 0;
      for (; shared != lattice.shared.end() && shared->cell == cell.slot; ++shared) {
        const double weight = elasticities[shared->label].rigidity_j * shared->fill.share;
        cell.stress += weight * stresses[shared->label];
        sum += weight;
      }
      if (first == shared)
        cell.stress = stresses[lattice.cell_labels[cell.slot]];
      else
        cell.stress /= sum;
      largest_n_ = std::max(largest_n_, cell.rigidity_j / h_ * cell.stress.norm());
    }
  }

  double energy() const override {
    double sum = 0;
    for (const Cell& cell : cells_) {
      const double trace = cell.stress.trace();
      sum += cell.rigidity_j * (cell.stress.squaredNorm() - cell.lambda / (2 + 3 * cell.lambda) * trace * trace);
    }
    return sum;
  }

  void pulls(Field& out) const override {
    for (const Cell& cell : cells_) addPull(cell, cell.stress, h_, out);
  }

  void multiply(const Field& at, Field& out) const override {
    for (const Cell& cell : cells_) {
      Matrix3d stress = elastic(cell, gradientOf(cell, at, h_));
      addPull(cell, -stress, h_, out);
    }
  }

  void addStiffness(std::vector<double>& sums) const override {
    for (const Cell& cell : cells_) {
      for (const uint32_t corner : cell.corners) sums[corner] += cell.rigidity_j * (1 + cell.lambda) / (h_ * h_);
    }
  }

  void take(const Field& at) override {
    for (Cell& cell : cells_) cell.stress += elastic(cell, gradientOf(cell, at, h_));
  }

  double h_;
  std::vector<Cell> cells_;
};

}  // namespace

void addCellPrestress(Body& body) {
  if (!isPrestressed(body.material, body.parts)) return;
  requirePrestrains(body);
  CellBalance balance(body);
  body.notes.push_back(balance.find());
  body.prestress.assign(body.lattice.nodes.size(), {});
  for (const Cell& cell : balance.cells()) {
    const Matrix3d& s = cell.stress;
    const double six[6] = {s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(2, 0), s(0, 1)};
    std::transform(six, six + 6, body.prestress[cell.slot].begin(), [](double v) { return static_cast<float>(v); });
  }
}

}  // namespace viscera
