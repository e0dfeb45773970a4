// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Cells in thin walls (material.thin_walls): which have a bend, and what it may do.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "model/body/thin_walls.h"
#include "support/lattices.h"
#include "viscera/model/body/elasticity.h"

namespace viscera::test {

namespace {

double lambdaOverMu(double nu) {
  return 2 * nu / (1 - 2 * nu);
}

size_t partialCells(const Body& body) {
  size_t sum = 0;
  for (const uint32_t fill : body.lattice.cell_fills) sum += fill != 0 ? 1 : 0;
  return sum;
}

/// Twice the energy of a cell by strains and hourglass motions, over mu h^3 and its share.
Eigen::Matrix<double, 15, 15> energyOf(const Body& body, const CellMoments& moments, const CellBend& bend) {
  const double lambda = lambdaOverMu(body.material.poisson_ratio);
  const CellFill& fill = moments.fills[moments.of_cell[bend.cell] - 1];
  const CellBending with = bendingOf({1, fill.first / fill.share, fill.second / fill.share}, lambda, bend.missing);
  Eigen::Matrix<double, 15, 15> out;
  out << solidStiffness(lambda), with.strains.transpose(), with.strains, with.bends;
  return out;
}

TEST(ThinWalls, BendsAreOfWallsOfLessThanFourCells) {
  for (const double thickness_cells : {0.6, 1.0, 1.5, 2.0}) {
    const Body body = thinBody(thickness_cells, 0.01);
    EXPECT_GT(static_cast<double>(cellMoments(body).bends.size()), 0.9 * static_cast<double>(partialCells(body)))
        << thickness_cells;
  }
  Body thick =
      momentBody({12, 12, 12}, 0.01, [](const Vector3d& p) { return (p - Vector3d::Constant(6.1)).norm() < 5; });
  thick.material.thin_walls = true;
  EXPECT_GT(partialCells(thick), 200u);
  EXPECT_TRUE(cellMoments(thick).bends.empty());
  Body asked_not = thinBody(1, 0.01);
  asked_not.material.thin_walls = false;
  EXPECT_TRUE(cellMoments(asked_not).bends.empty());
}

TEST(ThinWalls, ShareOfCellsInThemIsTold) {
  EXPECT_GT(thinShare(thinBody(1.2, 0.01).lattice), 0.9);
  const Body ball =
      momentBody({12, 12, 12}, 0.01, [](const Vector3d& p) { return (p - Vector3d::Constant(6.1)).norm() < 5; });
  EXPECT_EQ(thinShare(ball.lattice), 0);
  EXPECT_EQ(thinShare(boxBody({2, 2, 2}, 0.01).lattice), 0) << "no cell is in part";
}

/// Aligned walls of whole cells have none, as their cells are full.
TEST(ThinWalls, FullCellsAreAsTheyWere) {
  Body body = momentBody({8, 8, 1}, 0.01, [](const Vector3d&) { return true; });
  body.material.thin_walls = true;
  EXPECT_TRUE(cellMoments(body).bends.empty());
}

TEST(ThinWalls, EnergiesAreSquaresAndNoFasterThanTheStepAllows) {
  constexpr double kRounding = 1e-9;
  for (const double nu : {0.0, 0.25, 0.45, 0.49}) {
    for (const double thickness_cells : {0.3, 1.0, 1.7, 2.6}) {
      Body body = thinBody(thickness_cells, 0.01);
      body.material.poisson_ratio = nu;
      const CellMoments moments = cellMoments(body);
      // What dt_safe assumes of a cell (physics.md 2): 4.5 k of springs and 1.5 B / h^2 of volumes at each corner.
      const double limit = 4.5 + 1.5 * std::max(lambdaOverMu(nu) - 1, 0.0);
      for (const CellBend& bend : moments.bends) {
        Eigen::Matrix<double, 15, 15> energy = energyOf(body, moments, bend);
        const double largest = energy.norm();
        EXPECT_GT(Eigen::SelfAdjointEigenSolver<decltype(energy)>(energy).eigenvalues()[0], -kRounding * largest);
        // By displacements of the corners, whose patterns have these lengths.
        Eigen::Matrix<double, 15, 1> size;
        size << Vector3d::Constant(std::sqrt(0.5)), Vector3d::Ones(),
            Eigen::Matrix<double, 9, 1>::Constant(std::sqrt(2));
        energy = (size.asDiagonal() * energy * size.asDiagonal()).eval();
        EXPECT_LT(Eigen::SelfAdjointEigenSolver<decltype(energy)>(energy).eigenvalues()[14],
                  limit * (1 + 1e-6))  // constants of cells are float32
            << "nu " << nu << ", " << thickness_cells << " cells";
      }
    }
  }
}

/// A plate that bends: of second differences that corners do not show, most are those of the field.
TEST(ThinWalls, SecondDifferencesAreThoseOfAPlate) {
  constexpr double kOfTheField = 0.35;  // a patch of three cells is no plate yet; alone, cells miss more than that
  const double lambda = lambdaOverMu(0.25), across = -lambda / (lambda + 2);
  const Body body = thinBody(0.8, 0.01);
  const Vector3d n = Vector3d(0.5, 0.35, 0.8).normalized(), t = n.cross(Vector3d::UnitX()).normalized();
  const Eigen::Matrix3d bend = t * t.transpose() + across * n * n.transpose();
  Eigen::Matrix<double, 9, 1> shown, missing;
  const auto derivative = [&](int i, int j, int k) {
    return bend(i, j) * n[k] + bend(i, k) * n[j] - bend(j, k) * n[i];
  };
  for (int a = 0; a < 3; ++a) {
    for (int l = 0; l < 3; ++l) {
      shown[3 * a + l] = derivative(a, (l + 1) % 3, (l + 2) % 3);
      missing[3 * a + l] = derivative(a, l, l);
    }
  }
  double seen = 0, alone = 0, cells = 0;
  for (const CellBend& cell : cellMoments(body).bends) {
    const Vector3i at = body.lattice.nodeAt(cell.cell);
    if ((at.array() < 2).any() || at.x() > 4 || at.y() > 4 || at.z() > 3) continue;  // with tissue all around
    seen += (cell.missing * shown - missing).norm() / missing.norm();
    alone += (missingAlone(lambda) * shown - missing).norm() / missing.norm();
    ++cells;
  }
  ASSERT_GT(cells, 5);
  EXPECT_LT(seen / cells, kOfTheField);
  EXPECT_GT(alone / cells, 1.5 * kOfTheField);
}

}  // namespace

}  // namespace viscera::test
