// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "viscera/model/scene/body_config.h"

namespace viscera::bench {

/// Tissue that is torn by pulling (docs/physics.md 12): a plate with a slit of kSlit_m along x, from one of its ends.
struct TearTrial {
  double spacing_m = 0.002, young_modulus_pa = 20e3, toughness_j_per_m2 = 20, poisson_ratio = 0.25;
  double length_m = 0.08, width_m = 0.032, thickness_m = 0.004;
};

struct StripResult {
  double strain = 0;   ///< strain across the slit at which the slit grows
  double release = 0;  ///< energy per area that a slit releases from the strip in that state, over toughness
  size_t crumbs = 0;   ///< number of pieces of less than a twentieth of the nodes
};
/// Tests a notched strip: both long sides are held at an increasing strain.
StripResult pullStrip(const TearTrial& trial);

struct TrouserResult {
  double force = 0;            ///< mean force of a leg while the tear grows, over half of toughness times thickness
  double least = 0, most = 0;  ///< extremes of means over 4 mm of tear, in the same unit
  double trips = 0;
  size_t crumbs = 0;
};
/// Performs a trouser test: a grip at the end of each leg, pulled apart across the plate.
TrouserResult pullTrousers(const TearTrial& trial);

}  // namespace viscera::bench
