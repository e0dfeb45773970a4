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
  double length_m;    ///< from the pivot to the tips, > 0
  double closed_rad;  ///< opening at which the tips cross, > 0: edges lie length_m * sin(closed_rad / 2) off the pivot
};

Scissors scissorsOf(const ScissorsConfig& config);

/// How far from the pivot the edges cross [m], up to length_m: e / sin(opening / 2), e as in Scissors.
double crossing_m(const Scissors& scissors, double opening_rad);

/// By how much that grows as the blades close, per radian [m]; 0 where the tips have crossed.
double crossingPerRadian_m(const Scissors& scissors, double opening_rad);

/// Part of closing in one substep.
struct Closing {
  Pose from, to;              ///< of the tool
  double begin_rad, end_rad;  ///< opening
  double from_rad;            ///< opening at which this closing began: what was between the blades then is cut
};

/// The edge with which closing blades part tissue, as the blade of a stylus in mode cut: upright to the blades where
/// they cross, as long as the mouth was wide there when the closing began. Work per area, J, asks for the force J t on
/// its way, t the thickness of tissue there. Blades that open part nothing: the caller gives a mode that does not cut.
/// Writes from, to, blade_from and blade_to, xyz alone.
void setEdge(const Scissors& scissors, const Closing& closing, layout::ToolMotion& out);

/// Moment about the pivot with which the hand closes the blades [N m], by virtual work: the edge's force on its way
/// times crossingPerRadian_m() (Mahvash et al., Modeling the forces of cutting with scissors, IEEE Trans. Biomed. Eng.
/// 55(3), 2008). @param edge_n  force on the tissue along the crossing's way, from pivot to tips
double closingMoment_n_m(const Scissors& scissors, double opening_rad, double edge_n);

}  // namespace viscera
