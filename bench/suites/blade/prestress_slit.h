// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "bench/harness/report.h"
#include "viscera/model/scene/body_config.h"

namespace viscera::bench {

/// A slit that a blade cuts in the centre of a round prestressed sheet, which is fixed at its rim.
struct SlitTrial {
  Structure structure = Structure::kSurface;  ///< or kLattice, one or more cells thick
  double spacing_m = 0.002, thickness_m = 0.002;
  double half_m = 0.012;  ///< a, half of the slit's length [m]
  double radius = 6;      ///< radius of the sheet, over a
  double strain = 0.005;
  double poisson_ratio = 0.25;  ///< Poisson's ratio of a lattice; a sheet of triangles has 1/3
};

struct SlitResult {
  std::array<double, 3> opening{};  ///< opening relative to the law's, at kSlitPositions
  double asked = 0;                 ///< opening in the centre by the law [m]
  double uncut = 0;                 ///< largest displacement of a node before the cut, relative to the law's opening
  size_t nodes = 0;
  double trips = 0;
};
constexpr std::array<double, 3> kSlitPositions = {0, 0.5, 0.8};  ///< distances from the centre, over a

/// Measures the opening of a slit. In a large sheet it is 4 sigma a / E sqrt(1 - x^2 / a^2), sigma the stress before
/// the cut. A rim fixed at the radius R reduces it: sigma / (1 + c (a / R)^2),
/// c = (4 / (kappa - 1) + kappa + 3 / kappa) / 4, kappa = (3 - nu) / (1 + nu), from the slit's far field and the field
/// that cancels it on the rim, to second order in a / R (docs/physics.md 11).
SlitResult openSlit(const SlitTrial& trial);

/// Measures the part "prestress" of `viscera bench blade`.
void prestressSlits(Report& report);

}  // namespace viscera::bench
