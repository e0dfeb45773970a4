// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Second derivatives of the elastic energy.
#include <Eigen/Eigenvalues>

#include "solver/reference/deformed_spring.h"

namespace viscera {

namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

void addBlock(int row, int column, const Eigen::Matrix3d& block, Triplets& out) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) out.emplace_back(row + r, column + c, block(r, c));
}

template <class Matrix>
Matrix positivePart(const Matrix& m) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(m);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
}

/// Returns whether cells have equal laws, and one material each: of laminates it does not ask.
bool haveEqualLaws(const LawCell& a, const LawCell& b) {
  return !a.laminate.exists() && !b.laminate.exists() && a.rigidity_j == b.rigidity_j && a.bulk_j == b.bulk_j &&
         a.stiffening == b.stiffening && a.fill.first == b.fill.first && a.fill.second == b.fill.second &&
         a.prestress == b.prestress;
}

/// Returns d2 (k/2 extension^2) / d w2 of a spring, with its dashpot [N/m]. @param damping  c / dt
Eigen::Matrix3d springCurvature(const Vector3d& direction, double extension_m, double length_m, double k,
                                double damping, bool positive) {
  const Eigen::Matrix3d along = direction * direction.transpose();
  // Tension over length, the resistance of a spring to rotation; negative in compression. A spring without rest length
  // has k also at zero length: its force is k times the vector from end to end.
  double turning = length_m > 0 ? k * extension_m / length_m : k;
  if (positive) turning = std::max(0.0, turning);
  return (k + damping) * along + turning * (Eigen::Matrix3d::Identity() - along);
}

void addBetween(int near, int far, const Eigen::Matrix3d& block, Triplets& out) {
  addBlock(near, near, block, out);
  addBlock(far, far, block, out);
  addBlock(near, far, -block, out);
  addBlock(far, near, -block, out);
}

}  // namespace

void ReferenceLattice::addSprings(const Field& u_m, Curvature curvature, double dashpot_per_s, Triplets& out) const {
  for (uint32_t slot : active) {
    for (uint32_t s = 0; s < springsOf(slot) && !obeysLaw(slot); ++s) {
      const double k = isFirstEnd(slot, s) ? stiffness(slot, s) : 0;
      if (k == 0) continue;
      const Spring spring = springAt(u_m, slot, s);
      const double length_m = std::max(spring.length_m, kShortest * neighbor(slot, s).rest_m);
      const Eigen::Matrix3d block =
          springCurvature(spring.direction, spring.extension_m, length_m, k, dashpot(slot, s) * dashpot_per_s,
                          curvature == Curvature::kPositive);
      addBetween(dof(slot, 0), dof(farEnd(slot, s), 0), block, out);
    }
  }
}

void ReferenceLattice::addBroken(const Field& u_m, Curvature curvature, Triplets& out) const {
  for (const Cell& cell : cells_) {
    if (!isBroken(cell)) continue;
    forEachSpringOf(cell, [&](size_t, size_t, uint32_t slot, uint32_t s, double k) {
      const Spring spring = springOf(u_m[farEnd(slot, s)] - u_m[slot], cell, slot, s);
      const double length_m = std::max(spring.length_m, kShortest * neighbor(slot, s).rest_m);
      addBetween(
          dof(slot, 0), dof(farEnd(slot, s), 0),
          springCurvature(spring.direction, spring.extension_m, length_m, k, 0, curvature == Curvature::kPositive),
          out);
    });
  }
}

void ReferenceLattice::addWallStiffness(const Field& u_m, const Cell& cell, Curvature curvature, Triplets& out) const {
  const WallStencil stencil = stencilOf(cell);
  Eigen::MatrixXd m = lawCellCurvature(wallLaw(cell), motionOf(u_m, stencil));
  if (curvature == Curvature::kPositive) m = positivePart(m);
  for (const WallNode& a : stencil) {
    for (const WallNode& b : stencil) {
      Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
      for (int i = 0; i < 16; ++i)
        for (int j = 0; j < 16; ++j) block += a.share[i] * b.share[j] * m.block<3, 3>(3 * i, 3 * j);
      addBlock(dof(a.slot, 0), dof(b.slot, 0), block, out);
    }
  }
}

void ReferenceLattice::addCells(const Field& u_m, Curvature curvature, Triplets& out) const {
  using Modes = Eigen::Matrix<double, 21, 21>;
  // Derivatives are what costs, and where tissue rests, a cell has those of the cell before it.
  const LawCell* last = nullptr;
  CellModes last_motion = CellModes::Zero();
  Modes m = Modes::Zero();
  for (const Cell& cell : cells_) {
    if (!isWholeCell(cell)) continue;
    if (cell.isInWall()) {
      addWallStiffness(u_m, cell, curvature, out);
      continue;
    }
    const CellModes motion = motionOf(u_m, cell);
    if (!last || motion != last_motion || !haveEqualLaws(*last, cell.law)) {
      m = lawCellCurvature(cell.law, motion);
      if (curvature == Curvature::kPositive) m = positivePart(m);
      last = &cell.law;
      last_motion = motion;
    }
    for (size_t a = 0; a < 8; ++a) {
      const Eigen::Matrix<double, 7, 1> of_a = motionOfCorner(a, cell.spacing_m);
      for (size_t b = 0; b < 8; ++b) {
        const Eigen::Matrix<double, 7, 1> of_b = motionOfCorner(b, cell.spacing_m);
        Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
        for (int i = 0; i < 7; ++i)
          for (int j = 0; j < 7; ++j) block += of_a[i] * of_b[j] * m.block<3, 3>(3 * i, 3 * j);
        addBlock(dof(cell.corners[a], 0), dof(cell.corners[b], 0), block, out);
      }
    }
  }
}

Eigen::SparseMatrix<double> ReferenceLattice::stiffnessMatrix(const Field& u_m, Curvature curvature,
                                                              double dashpot_per_s) const {
  Triplets triplets;
  addSprings(u_m, curvature, dashpot_per_s, triplets);
  addCells(u_m, curvature, triplets);
  addBroken(u_m, curvature, triplets);
  Eigen::SparseMatrix<double> out(dofs(), dofs());
  out.setFromTriplets(triplets.begin(), triplets.end());
  return out;
}

}  // namespace viscera
