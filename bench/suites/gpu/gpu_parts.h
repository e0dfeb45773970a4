// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

// Parts of the gpu suite in separate files.

/// Measures kernels of leapfrog by the GPU's clock, as shares of its copy and multiply-add rates.
void measureKernels(Report& report);
/// Measures the time of mapping and drawing surface meshes of 0.1, 1 and 10 million faces [ms].
void measureFaces(Report& report);
/// Measures the cost of read-back per tick while it is in flight, and if every tick waits for it.
void measureFlight(Report& report);
/// Measures whether a heart of a million nodes runs in real time, with its surface mesh and 60 images a second.
void measureLive(Report& report);
/// Measures the OpenGL buffer size per node and per face [bytes].
void measureBytes(Report& report);

}  // namespace viscera::bench
