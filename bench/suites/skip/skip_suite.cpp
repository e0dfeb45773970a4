// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/pace/performance_suites.h"
#include "bench/suites/skip/skip_parts.h"

namespace viscera::bench {

void skipSuite(Report& report, gpu::Context& context) {
  measureFeatures(report);
  measureCells(report);
  measureEmptySpace(report);
  measureSleep(report);
  measureHidden(report);
  measureViews(report, context);
}

}  // namespace viscera::bench
