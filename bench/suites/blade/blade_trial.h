// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "viscera/model/scene/body_config.h"
#include "viscera/model/scene/solver_kinds.h"

namespace viscera::bench {

/// A blade that cuts through a clamped block: lengths in m, angles in degrees.
struct BladeTrial {
  double spacing_m = 0.002, young_modulus_pa = 20e3, toughness_j_per_m2 = 50;
  double speed_m_per_s = 0.1, angle_deg = 0, slicing = 0, beside = 0;  ///< `beside`: offset from a row of nodes,
                                                                       ///< relative to the spacing
  double length_m = 0.06, width_m = 0.048, thickness_m = 0.012, stroke_m = 0.045;
  Law law = Law::kNeoHookean;                 ///< law of lattices
  Structure structure = Structure::kLattice;  ///< surface: a sheet that is thickness_m thick
  bool there = true;                          ///< whether the blade cuts; otherwise the tissue is alone
  Backend backend = Backend::kCpu;            ///< the GPU requires a current context
  bool damped = true;                         ///< whether to measure the work of damping
};

struct BladeResult {
  double force = 0, ripple = 0;  ///< force over J_eff w in the last part of the stroke; peak to peak, relative
  double asked = 0;              ///< force over J w
  double along = 0;              ///< force along the edge, over J_eff w
  double onset_m = 0;            ///< displacement at which cutting begins [m]
  double area_m2 = 0;            ///< cut area [m2]
  double work_j = 0;
  double cut_share = 0, stored_share = 0;  ///< shares of the work: cutting; elastic and kinetic energy at the end
  double damped_share = 0;                 ///< share of drag and dashpots; 0 if it was not measured
  double worst_det = 1;                    ///< least volume of a whole cell or triangle, relative to rest
  double length_m = 0;                     ///< h of the law, Toughness::spacing_m [m]
  double trips = 0, stretch = 0;
  double substep_us = 0;  ///< time of a substep while the blade cuts, until its measurements are available [us]
  double fastest_us = 0;  ///< same in the fastest tick [us]
  size_t nodes = 0;
};
BladeResult cutThrough(const BladeTrial& trial);

}  // namespace viscera::bench
