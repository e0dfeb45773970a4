// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/layout/limits.h"
#include "viscera/model/model.h"

namespace viscera {

/// What E, nu and rho make of a cell of edge h (physics.md 1).
struct Elasticity {
  double spring_n_per_m;  ///< k = mu h of a full spring, axial or diagonal
  double bulk_j;          ///< (lambda - mu) h^3: what Poisson's ratio differs by from that of springs, 0 at nu = 1/4
  double rigidity_j;      ///< mu h^3
  double cell_mass_kg;    ///< rho h^3
};
Elasticity elasticity(double young_modulus_pa, double poisson_ratio, double density_kg_per_m3, double spacing_m);

/// [1 + parts] of full cells, by label; label 0 has those of no part.
/// @throws SceneError  as strengths()
std::vector<Elasticity> elasticityByLabel(const Body& body);

/// Strengths of a body whose cells differ, as assembled from them: what a count and a body-wide constant give
/// elsewhere. A spring between cells of two parts gets from each what it gives: it is as stiff as the cells around it
/// together. With `weights: paper` springs and masses are those of the mean of the cells around, at full count.
struct Strengths {
  std::vector<float> spring_n_per_m;  ///< [9 * slots] of the spring 2 i of a node at 9 * slot + i
  std::vector<float> mass_kg;         ///< [slots]
  std::vector<float> bulk_j;          ///< [slots] of the cell whose lowest corner is the node; 0 in bodies of springs
  std::vector<float> rigidity_j;      ///< [slots] likewise
};
constexpr uint32_t kSpringPairs = layout::kSpringsPerNode / 2;

/// Do its cells differ: are there parts with elasticities of their own, cells that are tissue in part,
/// or with a stress of their own?
bool isHeterogeneous(const Body& body);
/// @throws SceneError  a part that the body has not, or that stands twice
Strengths strengths(const Body& body);

/// Moments of the tissue in cells (Lattice::cell_fills and fills), weighed by its rigidity where a cell shares
/// materials.
struct CellMoments {
  std::vector<uint32_t> of_cell;  ///< [slots] 0 those of a full cell, else 1 + index into fills; empty where all are 0
  std::vector<CellFill> fills;
};
/// @throws SceneError  as strengths()
CellMoments cellMoments(const Body& body);

}  // namespace viscera
