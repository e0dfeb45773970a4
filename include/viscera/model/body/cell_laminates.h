// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "viscera/api.h"
#include "viscera/model/model.h"

namespace VISCERA_PUBLIC viscera {

/// Cell that two materials share, modelled as a laminate of two layers that meet in a plane (physics.md 1, Two
/// materials in a cell).
struct CellLaminate {
  uint32_t cell;           ///< slot of its lowest corner
  Eigen::Vector3d normal;  ///< unit normal of the plane in the lattice's axes, from layer a to layer b
  double share_a;          ///< volume of layer a over the volume of both, 0..1
  double rigidity_a;       ///< shear modulus of layer a over the volume-weighted mean of both
  double bulk_a, bulk_b;   ///< K / mu of each layer
  uint16_t label_a;        ///< label of layer a, as in Lattice::cell_labels

  double rigidity_b() const { return (1 - share_a * rigidity_a) / (1 - share_a); }
};

struct CellLaminates {
  std::vector<CellLaminate> cells;  ///< ascending by cell
  size_t others = 0;  ///< number of cells with three or more materials, or with layers that share a centroid: they keep
                      ///< Voigt's mean
};

/// Returns the cells of a body with the neo-Hookean law that two materials share; empty for other bodies.
/// @throws SceneError  as strengths()
CellLaminates cellLaminates(const Body& body);

}  // namespace viscera
