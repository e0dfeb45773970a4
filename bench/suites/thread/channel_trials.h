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

}  // namespace viscera::bench
