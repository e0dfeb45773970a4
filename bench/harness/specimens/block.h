// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "bench/harness/specimens/backends.h"
#include "solver/reference/reference_solver.h"
#include "viscera/model/scene/scene.h"

namespace viscera::bench {

/// A block of whole cells, its lowest corner at the origin. @param material  Law::kAuto: springs   @param fixed  which
/// nodes are held, or empty: none
Model blockModel(const Vector3i& cells, double spacing_m, const MaterialConfig& material,
                 const std::function<bool(const Vector3i& node)>& fixed = {});

/// Half of a hollow ball of whole cells, its round side up, held at its rim. @param radius, wall  in cells; a cell is
/// there if its middle is
Model domeModel(int radius, double wall, double spacing_m, const MaterialConfig& material);

/// Undamped, k = h = m = 1 for a block of spacing 1 m: E = 2.5 Pa, 1 kg/m3.
MaterialConfig unitMaterial();

/// "springs" or "neo_hookean".
std::string nameOf(Law law);

/// The material with a Poisson's ratio, and with the law that has it: springs at 1/4, elsewhere the neo-Hookean one.
MaterialConfig withPoisson(MaterialConfig material, double poisson_ratio);

/// Scene for a model that is there already: no gravity, no governor, no sleep, ticks of `substeps` substeps of
/// dt_fraction times the largest stable one.
Scene plainScene(const Model& model, int substeps, double dt_fraction = 0.5);

/// Everything at rest. [slots]
HostState restState(const Model& model);
/// Displacements as given, velocities zero. @param u_m  [slots]
HostState stateOf(const Model& model, const Field& u_m);

Vector3d xyz(const layout::vec4& v);
layout::vec4 vec4(const Vector3d& v);

/// Elastic forces of a backend on every node [slots, N]: from the velocity that half a kick gives it. The solver has
/// plainScene(): one substep per tick.
/// @param model  one body without drag
Field forcesOn(Backend backend, const Model& model, const Field& u_m);

}  // namespace viscera::bench
