// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace viscera::bench {

/// A suture through six tissue channels and then through six more. One end is fixed; a stylus in mode grab with at most
/// 20 N moves the other end in changing directions at up to 1 m/s. When all channels are torn out, and after 5 s, a new
/// block with the suture replaces the old one.
struct TearingTrial {
  double blocks = 1;
  double torn = 0, springs = 0;  ///< numbers of channels that were torn out and of springs cut behind them
  double substeps = 0, off = 0;  ///< substeps of the suture; substeps after which a link was off by more than 1e-3
  double worst_link = 0, iterations = 0;
  double waits = 0;  ///< number of substeps without a solution, in which the suture kept its position
  double trips = 0,
         nonfinite = 0;     ///< trips of the stability monitor; non-finite nodes of tissue and suture, counted in ticks
  double most_force_n = 0;  ///< largest force of the user, mean of a tick [N]
  double stretch = 0;       ///< largest stretch of the tissue
  double nearest_links = 1e9;  ///< smallest distance between two channels of the suture, at rest [links]
  double seconds_of_cpu = 0;
  uint64_t hash = 0;  ///< hash of the states before each new block and at the end
};
/// Runs the trial. @param sutures  number of CPU threads, which does not affect the result
TearingTrial tornOut(double seconds, double young_modulus_pa, int threads);

}  // namespace viscera::bench
