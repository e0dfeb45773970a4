// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

// The suites about speed (docs/benchmarks.md), with both backends in one run.

/// Measures VR05 figure 11: images per second by length of an incision; rate by share of springs cut at random.
void cutSuite(Report& report, gpu::Context& context);
/// Measures the time from a stylus pose to its force and to its image; regularity of ticks.
void latencySuite(Report& report, gpu::Context& context);
/// Measures the cost of an image of moving tissue, by stage and antialiasing, and the similarity of the images.
void pictureSuite(Report& report, gpu::Context& context);
/// Measures how fast the demo's heart is stepped while other processes use the CPU, by number of threads.
void busySuite(Report& report);

}  // namespace viscera::bench
