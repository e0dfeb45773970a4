// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "viscera/model/model.h"

namespace viscera {

struct Scene;

/// How springs of a lattice part by what material.tear.toughness_j_per_m2 says, G (docs/cutting.md 8): elastic up to
/// an onset, from there on they soften, and at the end they have taken the work of the area that they stand for.
struct TearLaw {
  /// Extensions of a spring [m].
  struct Spring {
    double onset_m = 0, end_m = 0;
  };
  std::array<Spring, 2> springs;  ///< axial, diagonal
  double onset_strain = 0;        ///< the lesser of the two, over the length of the spring

  /// Share of its stiffness that a spring has left that was longer than at rest by this.
  double left(bool axial, double extension_m) const;
};
/// @param body  that tears
TearLaw tearLawOf(const Body& body);

/// Does the tissue of a body, or some of a scene's, tear by energy?
bool tears(const Body& body);
bool tears(const Scene& scene);
/// May a thread that is pulled part it? Only where there are hands.
bool threadsTear(const Scene& scene);

}  // namespace viscera
