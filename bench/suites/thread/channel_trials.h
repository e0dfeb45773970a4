// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace viscera::bench {

/// A thread drawn through channels that turn it by 90 degrees in all, friction 0.3.
struct ChannelTrial {
  double ratio = 0;   ///< of tensions, mean while links pass, over exp(friction x angle)
  double ripple = 0;  ///< of it: farthest from its mean
  double iterations = 0;
};
/// @param bending_share  of a solid thread's   @param back_n  it is held back by
ChannelTrial drawnThroughChannels(size_t channels, double bending_share, double back_n);

/// A thread in flight through three channels of free masses, half a second, with friction and tearing.
struct TissueTrial {
  double momentum = 0;   ///< change, of the sum of m |v|
  double exchanged = 0;  ///< change, of the impulses between thread and tissue
  double off_m = 0;      ///< farthest of the thread from a channel's place
};
TissueTrial thrownThroughTissue();

/// A loop that is tied and holds 0.2 N, pulled by its tail: first by 0.9 of that, then so that it slips.
struct KnotTrial {
  double moved = 0;  ///< links that came through it before
  double slips = 0;  ///< tension of tail less that of the loop, over what it holds
  double worst_link = 0, off_m = 0;
};
KnotTrial pulledKnot();

/// CPU time of an iteration of 300 nodes with so many channels and knots [us].
double iterationCost_us(size_t channels, size_t knots);

}  // namespace viscera::bench
