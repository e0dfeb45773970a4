// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Threads beside the laws of docs/thread.md: bending, hanging, sliding over things and through channels, knots,
/// pulling, flight, cost, stress.
void threadSuite(Report& report);

}  // namespace viscera::bench
