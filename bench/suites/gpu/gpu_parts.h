// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

// Parts of the gpu suite that have files of their own.

/// Kernels of leapfrog by the GPU's clock, as shares of its copy and multiply-add rates.
void measureKernels(Report& report);
/// Milliseconds of mapping and of drawing skins of 0.1, 1 and 10 million faces.
void measureFaces(Report& report);
/// What read-back costs a tick while it is in flight, and where every tick waits for it.
void measureFlight(Report& report);
/// Is a heart of a million nodes stepped in real time, with its skin and 60 pictures a second?
void measureLive(Report& report);
/// Bytes of a node and of a face in OpenGL buffers.
void measureBytes(Report& report);

}  // namespace viscera::bench
