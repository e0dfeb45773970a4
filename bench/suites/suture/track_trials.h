// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace viscera::bench {

/// A suture drawn through channels that turn it by 90 degrees in all, friction 0.3.
struct TrackTrial {
  double ratio = 0;   ///< ratio of tensions, mean while links pass, over exp(friction x angle)
  double ripple = 0;  ///< largest deviation of the ratio from its mean
  double iterations = 0;
};
/// Runs the trial. @param bending_share  relative to a solid suture   @param back_n  force that holds it back [N]
TrackTrial drawnThroughTracks(size_t channels, double bending_share, double back_n);

/// A suture in flight through three channels of free masses, half a second, with friction and tearing.
struct TissueTrial {
  double momentum = 0;   ///< change of the sum of m |v|
  double exchanged = 0;  ///< change of the impulses between suture and tissue
  double off_m = 0;      ///< largest distance of the suture from a channel's position [m]
};
TissueTrial thrownThroughTissue();

/// A loop with a knot that holds 0.2 N, pulled at its tail: first with 0.9 of that, then until it slips.
struct KnotTrial {
  double moved = 0;  ///< number of links that passed the knot before it should slip
  double slips = 0;  ///< difference of tension between tail and loop, over the force that the knot holds
  double worst_link = 0, off_m = 0;
};
KnotTrial pulledKnot();

/// Returns the CPU time of an iteration of 300 nodes with these numbers of channels and knots [us].
double iterationCost_us(size_t channels, size_t knots);

}  // namespace viscera::bench
