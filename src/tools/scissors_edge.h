// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/layout/tool_motion.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/stylus_config.h"

namespace viscera {

/// Two straight blades on a pivot. In the frame of the tool the pivot is at (0, 0, length_m), the tips meet at the
/// origin, and the blades open in the plane of x and z, each by half of the opening.
struct Scissors {
  double length_m;    ///< distance from the pivot to the tips [m], > 0
  double closed_rad;  ///< opening at which the tips cross, > 0: edges are length_m * sin(closed_rad / 2) off the pivot
};

Scissors scissorsOf(const ScissorsConfig& config);

/// Returns the distance from the pivot to where the edges cross [m], up to length_m: e / sin(opening / 2), with e the
/// offset of the edges from the pivot.
double crossing_m(const Scissors& scissors, double opening_rad);

/// Returns the increase of that distance as the blades close, per radian [m]; 0 once the tips have crossed.
double crossingPerRadian_m(const Scissors& scissors, double opening_rad);

/// Part of closing in one substep.
struct Closing {
  Pose from, to;              ///< poses of the tool
  double begin_rad, end_rad;  ///< openings
  double from_rad;            ///< opening at which this closing began: what was between the blades then is cut
};

/// Sets the cutting edge of closing blades, as the blade of a stylus in mode cut. The edge is perpendicular to the
/// blades where they cross, and as long as the blades were apart there when the closing began. A toughness J requires
/// the force J t along its path, with t the thickness of tissue there. Blades that open do not cut: the caller then
/// gives a mode that does not cut. Writes only xyz of from, to, blade_from and blade_to.
void setEdge(const Scissors& scissors, const Closing& closing, layout::ToolMotion& out);

/// Returns the moment about the pivot with which the user closes the blades [N m], by virtual work: the edge's force
/// along its path times crossingPerRadian_m() (Mahvash et al., Modeling the forces of cutting with scissors, IEEE
/// Trans. Biomed. Eng. 55(3), 2008).
/// @param edge_n  force on the tissue along the path of the crossing, from pivot to tips
double closingMoment_n_m(const Scissors& scissors, double opening_rad, double edge_n);

}  // namespace viscera
