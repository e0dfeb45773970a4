// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/thin_walls.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "math/decompositions.h"
#include "viscera/model/body/bend_matrices.h"

namespace viscera {

namespace {

/// Thickness of a wall [cells] up to which all of the bend that its cells do not show is added, and from which on none
/// is: where no more than a tenth of a cell's bending is missed, cells at free surfaces, which yield too easily with
/// it, are the larger error (docs/material.md, Walls).
constexpr double kThin = 1.5, kThick = 4;
/// Of a line across a wall [cells]: a quarter of a cell is as fine as shares of cells tell.
constexpr double kStep = 0.25, kFarthest = 5;
/// Halvings of what is added, until a cell is slow enough: to 2 %.
constexpr int kHalvings = 6;
/// Of a patch's stiffness, so that a wall without thickness has one too.
constexpr double kLeastStiffness = 1e-9;

/// The tissue around a cell, as its corners see it.
struct Patch {
  double share = 0;  ///< cells
  Vector3d first = Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  ///< about the cell's middle

  void add(const CellFill& fill, const Vector3d& away, double weight) {
    share += weight * fill.share;
    first += weight * (fill.first + fill.share * away);
    second += weight * (fill.second + fill.first * away.transpose() + away * fill.first.transpose() +
                        fill.share * away * away.transpose());
  }
  /// Second moments about its own middle, over its volume.
  Eigen::Matrix3d spread() const { return second / share - first * first.transpose() / (share * share); }
};

class Walls {
 public:
  explicit Walls(const Lattice& lattice) : lattice_(lattice) {}

  /// A cell beside a corner counts as many corners as it shares with the cell in the middle: 8, 4, 2, 1 of 8.
  Patch patchOf(const Vector3i& cell) const {
    Patch out;
    for (int d = 0; d < 27; ++d) {
      const Vector3i away(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1);
      const int64_t slot = cellAt(cell + away);
      if (slot < 0) continue;
      out.add(fillOf(lattice_, static_cast<uint32_t>(slot)), away.cast<double>(),
              std::ldexp(1.0, -away.cwiseAbs().sum()));
    }
    return out;
  }
  /// Of the wall that a cell lies in, along the shortest axis of the tissue around it.
  double thicknessAround(const Vector3i& cell, const Eigen::Matrix3d& spread) const {
    const CellFill fill = fillOf(lattice_, static_cast<uint32_t>(cellAt(cell)));
    const Vector3d across = principalAxes(spread).axes.col(0);
    return thicknessAt(cell.cast<double>() + Vector3d::Constant(0.5) + fill.first / fill.share, across);
  }

 private:
  /// Tissue on the line through a place, in cells, as far as it is whole.
  double thicknessAt(const Vector3d& place, const Vector3d& along) const {
    double sum = 0;
    for (const double side : {-kStep, kStep}) {
      for (double n = 0.5; n * kStep < kFarthest; ++n) {
        const int64_t slot = cellAt((place + n * side * along).array().floor().cast<int>());
        if (slot < 0) break;
        sum += kStep * fillOf(lattice_, static_cast<uint32_t>(slot)).share;
      }
    }
    return sum;
  }
  /// Slot of a cell's lowest corner; negative: there is none.
  int64_t cellAt(const Vector3i& cell) const {
    const int64_t slot = lattice_.slotAt(cell);
    return slot >= 0 && lattice_.cell_labels[static_cast<size_t>(slot)] != 0 ? slot : -1;
  }
  const Lattice& lattice_;
};

/// Second differences by hourglass motions that cost a patch least.
BendMatrix cheapest(const Eigen::Matrix3d& spread, double lambda_over_mu) {
  const Eigen::Matrix<double, 18, 18> cost = gradientStiffness(spread, lambda_over_mu);
  BendMatrix own = cost.bottomRightCorner<9, 9>();
  own.diagonal().array() += kLeastStiffness * own.trace();
  return -own.ldlt().solve(cost.bottomLeftCorner<9, 9>());
}

/// Is no motion of the cell faster than dt_safe allows? Over its share and mu h.
bool isSlow(const CellFill& over_share, double lambda_over_mu, const BendMatrix& missing) {
  const CellBending bending = bendingOf(over_share, lambda_over_mu, missing);
  Eigen::Matrix<double, 15, 15> all;
  all << solidStiffness(lambda_over_mu), bending.strains.transpose(), bending.strains, bending.bends;
  // The displacements of corners behind strains along, shears and hourglass motions: squares of their patterns' sizes.
  Eigen::Matrix<double, 15, 1> size;
  size << Vector3d::Constant(std::sqrt(0.5)), Vector3d::Ones(), Eigen::Matrix<double, 9, 1>::Constant(std::sqrt(2));
  const double limit = 4.5 + 1.5 * std::max(lambda_over_mu - 1, 0.0);
  all = -(size.asDiagonal() * all * size.asDiagonal()).eval();
  all.diagonal().array() += limit;
  return Eigen::LLT<Eigen::Matrix<double, 15, 15>>(all).info() == Eigen::Success;
}

}  // namespace

std::vector<CellBend> cellBends(const Body& body, const CellMoments& moments) {
  const Lattice& lattice = body.lattice;
  std::vector<CellBend> out;
  if (moments.of_cell.empty()) return out;
  const Strengths table = strengths(body);
  const Walls walls(lattice);
  for (uint32_t slot = 0; slot < lattice.nodes.size(); ++slot) {
    const uint32_t which = moments.of_cell[slot];
    if (which == 0 || table.rigidity_j[slot] <= 0) continue;
    const double lambda = 1 + static_cast<double>(table.bulk_j[slot]) / static_cast<double>(table.rigidity_j[slot]);
    const CellFill& fill = moments.fills[which - 1];
    const CellFill over_share{1, fill.first / fill.share, fill.second / fill.share};
    const Vector3i cell = lattice.nodeAt(slot);
    const Eigen::Matrix3d spread = walls.patchOf(cell).spread();
    const double thin = std::clamp((kThick - walls.thicknessAround(cell, spread)) / (kThick - kThin), 0.0, 1.0);
    if (thin == 0) continue;
    const BendMatrix alone = missingAlone(lambda), change = cheapest(spread, lambda) - alone;
    double part = thin;
    if (!isSlow(over_share, lambda, alone + part * change)) {
      double too_much = part;
      part = 0;
      for (int i = 0; i < kHalvings; ++i) {
        const double between = 0.5 * (part + too_much);
        (isSlow(over_share, lambda, alone + between * change) ? part : too_much) = between;
      }
    }
    if (part > 0) out.push_back({slot, alone + part * change});
  }
  return out;
}

double thinShare(const Lattice& lattice) {
  constexpr size_t kLooked = 2000;
  const size_t every = std::max<size_t>(1, lattice.fills.size() / kLooked);
  const Walls walls(lattice);
  size_t partial = 0, looked = 0, thin = 0;
  for (uint32_t slot = 0; slot < lattice.cell_fills.size(); ++slot) {
    if (lattice.cell_fills[slot] == 0 || partial++ % every != 0) continue;
    const Vector3i cell = lattice.nodeAt(slot);
    ++looked;
    thin += walls.thicknessAround(cell, walls.patchOf(cell).spread()) < kFewCells ? 1 : 0;
  }
  return looked == 0 ? 0 : static_cast<double>(thin) / static_cast<double>(looked);
}

}  // namespace viscera
