// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "viscera/model/body/cell_laminates.h"
#include "viscera/model/body/elasticity.h"

namespace viscera {

/// Cauchy stress of a cell at the centroid of its tissue, at large strain. In a cell of two materials, that of the
/// labelled one.
struct CellStress {
  double energy_j_per_m3;  ///< of the volume at rest
  double von_mises_pa;
  Eigen::Vector3d principal_pa;  ///< largest first; tension above 0
  Eigen::Matrix3d cauchy_pa;
};

/// Computes the stress of the cells of one body in a state, by its law: neo-Hookean or, for springs, St.
/// Venant-Kirchhoff with their constants (docs/physics.md 1).
class CellStresses {
 public:
  /// @param body  with cells; must outlive this
  explicit CellStresses(const Body& body);

  /// Returns the stress of a cell. @param cell  slot of its lowest corner, of an existing cell   @param u_m
  /// displacements of the corners: bit 0 of the index x, bit 1 y, bit 2 z
  CellStress at(uint32_t cell, const std::array<Vector3d, 8>& u_m) const;

 private:
  struct Lame {
    double lambda, mu;
  };
  const Body& body_;
  std::vector<Lame> lames_;  ///< [parts + 1] without part, then by label
  CellMoments moments_;
  std::vector<CellLaminate> laminates_;  ///< ascending by cell
};

}  // namespace viscera
