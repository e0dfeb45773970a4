// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "viscera/model/model.h"

namespace viscera {

struct Scene;

/// Softening of lattice springs until they tear, by the toughness G = material.tear.toughness_j_per_m2 (docs/physics.md
/// 12). A spring is elastic up to an onset, and softens from there on. At its end it has absorbed the work of the area
/// that it represents.
struct TearLaw {
  /// Extensions of a spring [m] at onset and failure.
  struct Spring {
    double onset_m = 0, end_m = 0;
  };
  std::array<Spring, 2> springs;  ///< axial, diagonal
  double onset_strain = 0;        ///< strain at onset, the smaller of the two

  /// Returns the remaining share of its stiffness for the largest extension that a spring has had.
  double left(bool axial, double extension_m) const;
};
/// Returns the tear law of a body. @param body  a body that tears
TearLaw tearLawOf(const Body& body);

/// Returns whether the tissue of a body, or of some body of a scene, tears.
bool tears(const Body& body);
bool tears(const Scene& scene);
/// Returns whether a pulled suture may cut through tissue. Only where there are styluses.
bool suturesTear(const Scene& scene);

}  // namespace viscera
