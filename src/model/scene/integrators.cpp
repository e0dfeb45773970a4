// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/integrators.h"

#include <cmath>
#include <limits>

namespace viscera {

double stableFraction(Integrator integrator, double stiffness_damping_ratio) {
  const IntegratorTraits& traits = traitsOf(integrator);
  if (!traits.is_explicit) return std::numeric_limits<double>::infinity();
  const double xi = traits.dashpot_limits ? stiffness_damping_ratio : 0;
  return std::sqrt(1 + xi * xi) - xi;
}

SceneError notStepped(Integrator integrator, const std::string& by) {
  return SceneError("solver.integrator: " + by + " does not support '" + traitsOf(integrator).name + "'");
}

}  // namespace viscera
