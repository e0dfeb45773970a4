// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/model.h"

namespace viscera {

/// What a body's structure makes of material.cut.toughness_j_per_m2, J (docs/cutting.md).
struct Toughness {
  double asked_j_per_m2 = 0;
  double young_modulus_pa = 0;  ///< E, the smallest of the body's
  double spacing_m = 0;         ///< h; mean length of springs where there is no lattice

  /// What the structure carries of it: 2.5 E h at most. Nodes near the edge would be pushed through one another by
  /// more.
  double carried_j_per_m2() const;
  /// The same at a surface that the edge comes in by, where there is tissue ahead only: 0.23 E kernel_m() at most.
  double carriedAtSurface_j_per_m2() const;
  /// Within it nodes share the edge's force, more of them where there is more to carry.
  double kernel_m() const;
  /// How much is carried, for a person; empty: all of it.
  std::string note() const;
};
Toughness toughnessOf(const Body& body);

/// Does the tissue of a scene resist blades?
bool resistsBlades(const Scene& scene);
/// Does some of it not?
bool cutsFreely(const Scene& scene);
/// @throws SceneError  it does, and the integrator is none for it; names the key
void requireBladesFit(const Scene& scene);

}  // namespace viscera
