// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/accuracy_suite.h"

#include "bench/suites/accuracy_parts.h"

namespace viscera::bench {

void accuracySuite(Report& report) {
  measureOrder(report);
  measureFloat32(report);
  measureMomentum(report);
  measureEnergyDrift(report);
  measureCantileverPrecision(report);
  measureHeartPrecision(report);
  measureSpacing(report);
}

}  // namespace viscera::bench
