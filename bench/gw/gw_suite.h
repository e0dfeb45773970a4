// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Georgii & Westermann's experiments (docs/benchmarks.md, gw): their tables 1 and 2, and what they left out: errors.
/// Needs the context current.
void gwSuite(Report& report);

}  // namespace viscera::bench
