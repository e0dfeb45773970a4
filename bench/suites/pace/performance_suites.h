// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

// The suites about speed (docs/benchmarks.md), backends side by side in one run.

/// VR05 figure 11: pictures per second by length of an incision; rate by share of springs cut at random.
void cutSuite(Report& report, gpu::Context& context);
/// From a stylus pose to its force and to its picture; how even ticks are.
void latencySuite(Report& report, gpu::Context& context);
/// What a picture of moving tissue costs, stage by stage, by antialiasing, and how alike the pictures are.
void pictureSuite(Report& report, gpu::Context& context);
/// How fast the demo's heart is stepped beside processes that want the processors too, by threads.
void busySuite(Report& report);

}  // namespace viscera::bench
