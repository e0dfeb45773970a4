// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "viscera/model/scene/body_config.h"
#include "viscera/model/scene/solver_kinds.h"

namespace viscera::bench {

/// A blade that goes through a held block: lengths in m, angles in degrees.
struct BladeTrial {
  double spacing_m = 0.002, young_modulus_pa = 20e3, toughness_j_per_m2 = 50;
  double speed_m_per_s = 0.1, angle_deg = 0, slicing = 0, beside = 0;  ///< beside: of the spacing, off a row of nodes
  double length_m = 0.06, width_m = 0.048, thickness_m = 0.012, stroke_m = 0.045;
  Law law = Law::kNeoHookean;                 ///< of lattices
  Structure structure = Structure::kLattice;  ///< surface: a sheet, thickness_m thick
  bool there = true;                          ///< else the tissue is alone: nothing is cut
  Backend backend = Backend::kCpu;            ///< the GPU's needs a current context
  bool damped = true;                         ///< is it counted what damping takes?
};

struct BladeResult {
  double force = 0, ripple = 0;  ///< over J_eff w in the last part of the stroke; peak to peak, over the mean
  double asked = 0;              ///< the force over J w
  double along = 0;              ///< force along the edge, over J_eff w
  double onset_m = 0;            ///< of the way, where cutting begins
  double area_m2 = 0;            ///< parted
  double work_j = 0;
  double cut_share = 0, stored_share = 0;  ///< of the work: parting; elastic and kinetic energy at the end
  double damped_share = 0;                 ///< by drag and dashpots; 0 where it was not asked for
  double worst_det = 1;                    ///< least volume of a whole cell or triangle, over that at rest
  double length_m = 0;                     ///< h of the law, Toughness::spacing_m
  double trips = 0, stretch = 0;
  double substep_us = 0;  ///< while the blade cuts, until its measurements are there
  double fastest_us = 0;  ///< the same in the tick that took least
  size_t nodes = 0;
};
BladeResult cutThrough(const BladeTrial& trial);

}  // namespace viscera::bench
