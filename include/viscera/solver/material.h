// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/model/model.h"

namespace viscera {

/// What E, nu and rho make of a cell of edge h (physics.md 1).
struct Elasticity {
  double spring_n_per_m;  ///< k = mu h of a full spring, axial or diagonal
  double bulk_j;          ///< lambda_V h^3, lambda_V = lambda - mu; 0 at nu = 1/4
  double cell_mass_kg;    ///< rho h^3
};
Elasticity elasticity(double young_modulus_pa, double poisson_ratio, double density_kg_per_m3, double spacing_m);

/// Strengths of a body whose cells differ, as assembled from them: what a count and a body-wide constant give
/// elsewhere. A spring between cells of two parts gets from each what it gives: it is as stiff as the cells around it
/// together. With `weights: paper` springs and masses are those of the mean of the cells around, at full count.
struct Strengths {
  std::vector<float> spring_n_per_m;  ///< [9 * slots] of the spring 2 i of a node at 9 * slot + i
  std::vector<float> mass_kg;         ///< [slots]
  std::vector<float> bulk_j;          ///< [slots] of the cell whose lowest corner is the node
};
constexpr uint32_t kSpringPairs = layout::kSpringsPerNode / 2;

/// Do parts of the body have elasticities of their own?
bool isHeterogeneous(const Body& body);
/// @throws SceneError  a part that the body has not, or that stands twice
Strengths strengths(const Body& body);

/// Material constants of a body as the kernels take them.
layout::BodyParams bodyParams(const Body& body, double dt_safe_s);
std::vector<layout::BodyParams> bodyParams(const Model& model, double dt_safe_s);  ///< [bodies]

/// Has any cell of the model an energy of volume (nu other than 1/4)?
bool hasVolumeEnergy(const Model& model);
bool isHeterogeneous(const Model& model);

/// Largest stable substep of a lattice without dashpot, however it is deformed [s]: 2 / omega with
/// omega^2 = max over free nodes of (2 sum of k + 1.5 / h^2 sum of the positive bulk_j of the cells around) / m
/// (physics.md 2; exact bound for springs in any state, for the energy of volume near rest).
double safeTimeStep(const Model& model);

/// Fastest wave in any body [m/s]: c_p = sqrt((lambda + 2 mu) / rho) (physics.md 1).
double waveSpeed(const Model& model);

/// Largest speed at which a probe pushes nodes out of itself [m/s]: four times that of waves, more than squeezed tissue
/// can resist and less than a shot (physics.md 5).
double pushSpeed(const Model& model);

}  // namespace viscera
