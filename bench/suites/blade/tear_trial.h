// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "viscera/model/scene/body_config.h"

namespace viscera::bench {

/// Tissue that is pulled apart (docs/cutting.md 8): a plate with a slit of kSlit_m along x, from one of its ends.
struct TearTrial {
  double spacing_m = 0.002, young_modulus_pa = 20e3, toughness_j_per_m2 = 20, poisson_ratio = 0.25;
  double length_m = 0.08, width_m = 0.032, thickness_m = 0.004;
};

struct StripResult {
  double strain = 0;   ///< at which the slit goes on, across it
  double release = 0;  ///< energy per area that a slit takes from the strip as it is then, over toughness
  size_t crumbs = 0;   ///< pieces of less than a twentieth of the nodes
};
/// Notched strip: both of its long sides held at a strain, from little to more.
StripResult pullStrip(const TearTrial& trial);

struct TrouserResult {
  double force = 0;            ///< mean of a leg while the tear goes on, over half of toughness times thickness
  double least = 0, most = 0;  ///< of means over 4 mm of tear, the same way
  double trips = 0;
  size_t crumbs = 0;
};
/// Trouser test: a grip at the end of each leg, pulled apart across the plate.
TrouserResult pullTrousers(const TearTrial& trial);

}  // namespace viscera::bench
