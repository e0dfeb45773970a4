// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace viscera {

/// What has run out of cut vessels since the last reset (docs/lessons/bleeding.md). bled_ml is the sum of the two below
/// it.
struct SeenBlood {
  double bled_ml = 0;
  double on_tissue_ml = 0;
  double dripped_ml = 0;
  double flow_ml_per_min = 0;  ///< now, of all vessels together
  uint64_t stumps = 0;         ///< pieces of vessels that bleed now
};

}  // namespace viscera
