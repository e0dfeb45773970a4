// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

// The measurements of the egve suite, one file each (docs/surface.md).

/// Measures the time of each mapping: 50,000 faces on 20,000 nodes, 10,000 on 18 (EGVE 3.4).
void measureMappingTimes(Report& report);
/// Measures the error of each mapping with exact nodes: bending, twist and indentation in closed form.
void measureMappingErrors(Report& report);
/// Measures the errors in equilibria of a lattice four times finer, in float64.
void measureFinerErrors(Report& report);

}  // namespace viscera::bench
