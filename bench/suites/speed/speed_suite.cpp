// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/speed/speed_suite.h"

#include "bench/suites/speed/speed_parts.h"

namespace viscera::bench {

namespace {

/// Runs a part that compares the backends.
template <void (*kMeasure)(Report&)>
void ofBoth(Report& report) {
  if (report.backends().size() > 1) return kMeasure(report);
  report.note("A part is skipped: it compares both backends, see --backend.\n");
}

template <void (*kMeasure)(Report&)>
void ofGpu(Report& report) {
  if (report.context()) return kMeasure(report);
  report.note("A part is skipped: it measures the GPU backend, see --backend.\n");
}

}  // namespace

void speedSuite(Report& report) {
  measureParts(report, {{"sizes", measureSizes},
                        {"simd", measureSimd},
                        {"explicit", ofBoth<measureExplicit>},
                        {"heart", ofBoth<measurePressedHeart>},
                        {"sessions", ofBoth<measureHeartSessions>},
                        {"features", ofBoth<measureFeatures>},
                        {"cells", ofBoth<measureCells>},
                        {"sleep", ofBoth<measureSleep>},
                        {"hidden", ofGpu<measureHidden>},
                        {"views", ofBoth<measureViews>},
                        {"ticks", measureTicks},
                        {"stages", ofGpu<measureTickStages>}});
}

}  // namespace viscera::bench
