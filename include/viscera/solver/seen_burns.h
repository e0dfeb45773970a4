// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace viscera {

/// What tools of mode cautery have done since the last reset (docs/lessons/cautery.md). given_j is the sum of the four
/// below it.
struct SeenBurns {
  double given_j = 0;        ///< heat from tips
  double stored_j = 0;       ///< in the tissue, above that of the body; water that boils off has taken its own along
  double steam_j = 0;        ///< gone with water that has boiled off
  double perfused_j = 0;     ///< taken away by blood
  double surface_j = 0;      ///< given to the air
  double hottest_c = 37;     ///< of any node now
  double coagulated_m3 = 0;  ///< tissue of which more than 63 % is coagulated
  uint64_t parted = 0;       ///< nodes that lost their springs as their water boiled
};

}  // namespace viscera
