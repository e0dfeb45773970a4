// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/accuracy/accuracy_suite.h"

#include "bench/suites/accuracy/accuracy_parts.h"

namespace viscera::bench {

void accuracySuite(Report& report) {
  measureParts(report, {{"order", measureOrder},
                        {"float32", measureFloat32},
                        {"momentum", measureMomentum},
                        {"energy", measureEnergyDrift},
                        {"cantilever", measureCantileverPrecision},
                        {"heart", measureHeartPrecision},
                        {"spacing", measureSpacing}});
}

}  // namespace viscera::bench
