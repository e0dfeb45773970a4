// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/api.h"
#include "viscera/layout/limits.h"
#include "viscera/model/model.h"

namespace VISCERA_PUBLIC viscera {

/// Constants of a cell of edge h that follow from E, nu and rho (physics.md 1).
struct Elasticity {
  double spring_n_per_m;  ///< stiffness k = mu h of a full spring, axial or diagonal [N/m]
  double bulk_j;      ///< (lambda - mu) h^3 [J]: the volume term beyond the springs' own Poisson's ratio, 0 at nu = 1/4
  double rigidity_j;  ///< mu h^3 [J]
  double cell_mass_kg;  ///< rho h^3 [kg]
};
Elasticity elasticity(double young_modulus_pa, double poisson_ratio, double density_kg_per_m3, double spacing_m);

/// Returns the constants of full cells by label, [1 + parts]; label 0 has those of cells without a part.
/// @throws SceneError  as strengths()
std::vector<Elasticity> elasticityByLabel(const Body& body);

/// Stiffness and mass of every spring and node of a body with cells that differ, assembled cell by cell. In other
/// bodies a count and a body-wide constant give them. A spring between cells of two parts gets a share from each cell
/// around it. With `weights: paper`, springs and masses use the mean of the cells around them, at full count.
struct Strengths {
  std::vector<float> spring_n_per_m;  ///< [9 * slots] stiffness of spring 2 i of a node at 9 * slot + i [N/m]
  std::vector<float> mass_kg;         ///< [slots] mass of the node [kg]
  /// [slots] bulk_j of the cell that has the node as its lowest corner [J]; 0 in bodies of springs.
  std::vector<float> bulk_j;
  std::vector<float> rigidity_j;  ///< [slots] rigidity_j of that cell [J]; 0 in bodies of springs
};
constexpr uint32_t kSpringPairs = layout::kSpringsPerNode / 2;

/// Returns whether the cells of the body differ: parts with elasticities of their own, partly filled cells, or a
/// prestress.
bool isHeterogeneous(const Body& body);
/// Assembles the strengths of a heterogeneous body.
/// @throws SceneError  a part that the body does not have, or that is listed twice
Strengths strengths(const Body& body);

/// Moments of the tissue in cells (Lattice::cell_fills and fills), weighted by rigidity where materials share a cell.
struct CellMoments {
  /// [slots] 0: moments of a full cell, else 1 + index into fills; empty where all are 0.
  std::vector<uint32_t> of_cell;
  std::vector<CellFill> fills;
};
/// Returns the moments of the cells of a body.
/// @throws SceneError  as strengths()
CellMoments cellMoments(const Body& body);

}  // namespace viscera
