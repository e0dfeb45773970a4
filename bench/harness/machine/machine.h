// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace viscera::bench {

// Measured limits of this machine (docs/benchmarks.md, speed).

/// Returns bytes read plus bytes written per second by memcpy between arrays far larger than caches.
/// @param threads  concurrent threads, each with arrays of its own   @param mebibytes  size of each array
double copyRate(int threads, size_t mebibytes);
/// Returns float32 operations per second of fused multiply-adds in registers (two operations each) with the best
/// instruction set.
/// @param threads  concurrent threads   @param seconds  duration of the measurement
double fmaRate(int threads, double seconds);
std::string fmaTarget();  ///< instruction set of fmaRate()

/// Repeats some work, each time to its end, for 0.4 s: an idle GPU takes some tenths of a second to reach its full
/// clock.
void warmUpGpu(const std::function<void()>& work);
/// Returns the rates of the current context's renderer: copies between buffers, and (below) multiply-adds in a compute
/// shader.
double gpuCopyRate(size_t mebibytes);  ///< size of each buffer, limited by the largest storage block of the driver
double gpuFmaRate(double seconds);

/// Returns the resident memory of this process [bytes].
double residentBytes();
int processors();

}  // namespace viscera::bench
