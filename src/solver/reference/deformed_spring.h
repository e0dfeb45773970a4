// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/reference/reference_lattice.h"

namespace viscera {

constexpr double kShortest = 1e-6;  ///< share of the rest length: a shorter spring keeps its direction at rest

struct ReferenceLattice::Spring {
  Vector3d direction;  ///< n, unit vector to the far end
  double length_m;     ///< L
  double extension_m;  ///< L - l0
};

/// Returns the deformed spring. @param w  u_far - u_near [m]
inline ReferenceLattice::Spring ReferenceLattice::springBetween(const Neighbor& n, const Vector3d& w) {
  const Vector3d edge = n.offset_m + w;
  const double length = edge.norm();
  // Without cancellation (physics.md 2). The prestrain |d|^2 - l0^2 is 0 in a lattice.
  const double prestrain = n.spring < 0 ? 0 : n.offset_m.squaredNorm() - n.rest_m * n.rest_m;
  const double sum = length + n.rest_m;
  const double extension = sum > 0 ? (2 * n.offset_m.dot(w) + w.squaredNorm() + prestrain) / sum : 0;
  const bool has_direction = length > kShortest * n.rest_m;
  return {has_direction ? Vector3d(edge / length) : n.offset_m.normalized(), length, extension};
}

inline ReferenceLattice::Spring ReferenceLattice::springAt(const Field& u_m, uint32_t slot, uint32_t spring) const {
  const Neighbor& n = neighbor(slot, spring);
  return springBetween(n, u_m[n.slot] - u_m[slot]);
}

/// Returns a spring of a cell that has lost one. The remaining springs carry the cell's prestress
/// (CpuStrengths::setBroken()). @param w_m  displacement of the far end relative to the near one
inline ReferenceLattice::Spring ReferenceLattice::springOf(const Vector3d& w_m, const Cell& cell, uint32_t slot,
                                                           uint32_t spring) const {
  Neighbor n = neighbor(slot, spring);
  const Eigen::Matrix3d strain =
      0.5 * (cell.law.prestress - cell.law.prestress.trace() / 5 * Eigen::Matrix3d::Identity());
  n.rest_m *= 1 - n.offset_m.dot(strain * n.offset_m) / n.offset_m.squaredNorm();
  n.spring = 0;  // its rest length is not that of the lattice
  return springBetween(n, w_m);
}

/// Calls visit(corner, far corner, slot, spring, k) for each whole spring of a cell; k is the share of the cell.
template <class Visit>
void ReferenceLattice::forEachSpringOf(const Cell& cell, Visit visit) const {
  const double quarter = cell.law.rigidity_j / (4 * cell.spacing_m * cell.spacing_m);
  for (size_t c = 0; c < 8; ++c) {
    const uint32_t slot = cell.corners[c];
    for (uint32_t s = 0; s < layout::kSpringsPerNode; s += 2) {
      size_t far = 0;
      bool inside = true;
      for (size_t axis = 0; axis < 3; ++axis) {
        const int to = static_cast<int>(c >> axis & 1) + kNeighborOffsets[s][axis];
        inside = inside && (to == 0 || to == 1);
        far |= static_cast<size_t>(to == 1) << axis;
      }
      if (inside && isWhole(slot, s)) visit(c, far, slot, s, isAxial(s) ? quarter : 2 * quarter);
    }
  }
}

/// Returns the sign of the axis at corner c of a cell: -1 or 1.
inline double cornerSign(size_t corner, int axis) {
  return (corner >> axis) & 1u ? 1 : -1;
}

/// Returns det(1 + g) - 1, without cancellation.
}  // namespace viscera
