// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/layout/nodes.h"
#include "viscera/model/body/elasticity.h"
#include "viscera/model/model.h"

namespace viscera {

/// Material constants of a body as the kernels take them.
layout::BodyParams bodyParams(const Body& body, double dt_safe_s);
std::vector<layout::BodyParams> bodyParams(const Model& model, double dt_safe_s);  ///< [bodies]

double massOf_kg(const Body& body);  ///< all of its nodes
bool isHeterogeneous(const Model& model);
/// Does some body's material have a hyperelastic law (Law)?
bool hasLaw(const Model& model);
/// Do the springs of lattices pull where nodes will be, in place of their dashpots while they are mild (leapfrog;
/// physics.md 2)?
bool predictsSprings(const Model& model);

/// Largest stable substep of a lattice without dashpot, however it is deformed [s]: 2 / omega with
/// omega^2 = max over free nodes of (2 sum of k + 1.5 / h^2 sum of the positive bulk_j of the cells around) / m
/// (physics.md 2; exact bound for springs in any state; for cells of a law see physics.md 2).
double safeTimeStep(const Model& model);

/// Fastest wave in any body [m/s]: c_p = sqrt((lambda + 2 mu) / rho) (physics.md 1).
double waveSpeed(const Model& model);

/// Largest speed at which a probe pushes nodes out of itself [m/s]: four times that of waves, more than squeezed tissue
/// can resist and less than a shot (physics.md 5).
double pushSpeed(const Model& model);

}  // namespace viscera
