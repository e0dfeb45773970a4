// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "bench/harness/specimens/backends.h"
#include "solver/reference/reference_solver.h"
#include "viscera/model/scene/scene.h"

namespace viscera::bench {

/// Creates a block of full cells with its lowest corner at the origin. @param material  Law::kAuto: springs
/// @param fixed  selects fixed nodes; empty: none
Model blockModel(const Vector3i& cells, double spacing_m, const MaterialConfig& material,
                 const std::function<bool(const Vector3i& node)>& fixed = {});

/// Creates half of a hollow ball of full cells, round side up, fixed at its rim.
/// @param radius, wall  [cells]; a cell exists if its centre is inside
Model domeModel(int radius, double wall, double spacing_m, const MaterialConfig& material);

/// Returns an undamped material with k = h = m = 1 for a block of spacing 1 m: E = 2.5 Pa, 1 kg/m3.
MaterialConfig unitMaterial();

/// Returns "springs" or "neo_hookean".
std::string nameOf(Law law);

/// Returns the material with a Poisson's ratio and a law that supports it: springs at 1/4, otherwise neo-Hookean.
MaterialConfig withPoisson(MaterialConfig material, double poisson_ratio);

/// Returns a scene for an existing model: no gravity, stability monitor or sleep; ticks of `substeps` substeps of
/// dt_fraction times the largest stable one.
Scene plainScene(const Model& model, int substeps, double dt_fraction = 0.5);

/// Returns the state at rest. [slots]
HostState restState(const Model& model);
/// Returns a state with the given displacements and zero velocities. @param u_m  [slots]
HostState stateOf(const Model& model, const Field& u_m);

Vector3d xyz(const layout::vec4& v);
layout::vec4 vec4(const Vector3d& v);

/// Returns the elastic forces of a backend on every node [slots, N], from the velocity after half a kick. The solver
/// has plainScene() with one substep per tick.
/// @param model  one body without drag
Field forcesOn(Backend backend, const Model& model, const Field& u_m);

}  // namespace viscera::bench
