// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "viscera/math/types.h"
#include "viscera/model/body/cell_laminates.h"

namespace viscera {

/// One layer of a laminate (physics.md 1, Two materials in a cell).
struct LawLayer {
  double weight = 0;        ///< shear modulus times share of the volume, over the mean modulus; both sum to 1
  double jump = 0;          ///< signed share of the other layer: F of the layer is F + jump a N^T
  double bulk_over_mu = 0;  ///< K / mu
};

/// Two materials in a cell, with a plane interface.
struct LawLaminate {
  Vector3d normal = Vector3d::Zero();  ///< N, unit, in the lattice's axes
  LawLayer layers[2];

  bool exists() const { return layers[1].weight > 0; }
};

LawLaminate lawLaminateOf(const CellLaminate& cell);

/// Returns the jump a that minimises the energy of both layers; the traction is then the same on either side. Newton's
/// method with a line search, to rounding.
/// @param f  mean deformation gradient   @param stiffening  b of lawShear()
Vector3d laminateJump(const LawLaminate& laminate, const Eigen::Matrix3d& f, double stiffening);

}  // namespace viscera
