// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/api.h"
#include "viscera/layout/nodes.h"
#include "viscera/model/body/elasticity.h"
#include "viscera/model/model.h"

namespace VISCERA_PUBLIC viscera {

/// Returns the material constants of a body in the layout of the kernels.
layout::BodyParams bodyParams(const Body& body, double dt_safe_s);
std::vector<layout::BodyParams> bodyParams(const Model& model, double dt_safe_s);  ///< [bodies]

double massOf_kg(const Body& body);  ///< total mass of its nodes
bool isHeterogeneous(const Model& model);
/// Returns whether some body's material has a hyperelastic law (Law).
bool hasLaw(const Model& model);
/// Returns whether lattice springs use predicted node positions instead of their dashpots while they are mildly
/// stretched (leapfrog; physics.md 2).
bool predictsSprings(const Model& model);

/// Returns the largest substep [s] at which a lattice without dashpots is stable, however it is deformed: 2 / omega
/// with omega^2 = max over free nodes of (2 sum of k + 1.5 / h^2 sum of the positive bulk_j of the cells around) / m
/// (physics.md 2). The bound is exact for springs in any state; for cells of a law see physics.md 2.
double safeTimeStep(const Model& model);

/// Returns the speed of the fastest wave in any body [m/s]: c_p = sqrt((lambda + 2 mu) / rho) (physics.md 1).
double waveSpeed(const Model& model);

/// Returns the largest speed at which a probe pushes nodes out of itself [m/s]: four times the wave speed. Squeezed
/// tissue cannot resist it, and nodes are not shot away (physics.md 5).
double pushSpeed(const Model& model);

}  // namespace viscera
