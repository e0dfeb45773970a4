// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

// Of the table1 suite (docs/benchmarks.md). A heart of VR05's size in a scene as sessions have it:

/// Simulation only, one probe pressed in.
void measurePressedHeart(Report& report);
/// Through Session, with skin and pictures: what of real time is left.
void measureHeartSessions(Report& report, gpu::Context& context);
/// VR05 Table 1's third column: the lattice with explicit connections, on both backends.
void measureExplicit(Report& report);

}  // namespace viscera::bench
