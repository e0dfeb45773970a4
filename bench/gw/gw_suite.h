// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Runs Georgii & Westermann's experiments (docs/benchmarks.md, gw): their tables 1 and 2, and errors, which they do
/// not report. Requires a current context.
void gwSuite(Report& report);

}  // namespace viscera::bench
