// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/gw/gw_suite.h"

#include "bench/gw/gw_parts.h"

namespace viscera::bench {

void gwSuite(Report& report) {
  countCosts(report);
  measureStages(report);
  measureForceErrors(report);
  measureMotionErrors(report);
  collisionRecall(report, report.isShort());
}

}  // namespace viscera::bench
