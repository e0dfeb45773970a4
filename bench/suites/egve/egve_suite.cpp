// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/egve/egve_suite.h"

#include "bench/suites/egve/egve_parts.h"

namespace viscera::bench {

void egveSuite(Report& report) {
  measureParts(report,
               {{"times", measureMappingTimes}, {"errors", measureMappingErrors}, {"finer", measureFinerErrors}});
}

}  // namespace viscera::bench
