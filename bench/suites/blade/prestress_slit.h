// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "bench/harness/report.h"
#include "viscera/model/scene/body_config.h"

namespace viscera::bench {

/// A slit that a blade makes in the middle of a round sheet, which is held all around and has a prestress.
struct SlitTrial {
  Structure structure = Structure::kSurface;  ///< or kLattice, one cell thick or more
  double spacing_m = 0.002, thickness_m = 0.002;
  double half_m = 0.012;  ///< a, half of its length
  double radius = 6;      ///< of the sheet, over a
  double strain = 0.005;
  double poisson_ratio = 0.25;  ///< of a lattice; a sheet of triangles has 1/3
};

struct SlitResult {
  std::array<double, 3> opening{};  ///< over that of the law, at kSlitPlaces
  double asked = 0;                 ///< in the middle [m], by the law
  double uncut = 0;                 ///< how far a node went before the cut, over the opening asked for
  size_t nodes = 0;
  double trips = 0;
};
constexpr std::array<double, 3> kSlitPlaces = {0, 0.5, 0.8};  ///< from the middle, over a

/// The opening of a slit in a large sheet is 4 sigma a / E sqrt(1 - x^2 / a^2), sigma the stress before the cut. A rim
/// that is held at the radius R pulls less: sigma / (1 + c (a / R)^2), c = (4 / (kappa - 1) + kappa + 3 / kappa) / 4,
/// kappa = (3 - nu) / (1 + nu), from the slit's far field and the field that undoes it on the rim, to second order in
/// a / R (docs/cutting.md 6).
SlitResult openSlit(const SlitTrial& trial);

/// The part "prestress" of `viscera bench blade`.
void prestressSlits(Report& report);

}  // namespace viscera::bench
