// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {

/// Blood, or bile, from cut vessels since the last reset (docs/lessons/instruments.md). bled_ml is the sum of
/// on_tissue_ml, dripped_ml and suctioned_ml.
struct BloodReport {
  double bled_ml = 0;
  double on_tissue_ml = 0;
  double dripped_ml = 0;
  double suctioned_ml = 0;     ///< taken away by tools with mode suction
  double flow_ml_per_min = 0;  ///< present flow of all vessels together [ml/min]
  uint64_t stumps = 0;         ///< number of pieces of vessels that bleed now
};

}  // namespace viscera
