// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

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

/// How much of what is seen of nodes is blood.
struct BloodPaint {
  uint64_t revision = 0;      ///< grows when a share changes
  std::vector<float> shares;  ///< [slots] 0 clean, 1 blood alone
};

}  // namespace viscera
