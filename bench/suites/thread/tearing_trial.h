// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace viscera::bench {

/// A thread through six channels of tissue and again through six, one end held, the other drawn about in changing
/// directions at up to 1 m/s by a stylus in mode grab that has at most 20 N. Where all channels are torn out, and after
/// 5 s, there is a new block with the thread in it.
struct TearingTrial {
  double blocks = 1;
  double torn = 0, springs = 0;  ///< channels that were torn out; springs that were cut behind them
  double substeps = 0, off = 0;  ///< of the thread; those after which a link was off by more than 1e-3
  double worst_link = 0, iterations = 0;
  double waits = 0;                 ///< substeps without a solution, in which the thread stayed where it was
  double trips = 0, nonfinite = 0;  ///< of the governor; nodes of tissue and thread in ticks
  double most_force_n = 0;          ///< of the hand, mean of a tick
  double stretch = 0;               ///< of tissue, largest
  double nearest_links = 1e9;       ///< two channels of the thread, at rest
  double seconds_of_cpu = 0;
  uint64_t hash = 0;  ///< of the states before each new block and at the end
};
/// @param threads  of the processor: they change nothing
TearingTrial tornOut(double seconds, double young_modulus_pa, int threads);

}  // namespace viscera::bench
