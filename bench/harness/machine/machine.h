// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace viscera::bench {

// What this machine can do at most, measured (docs/benchmarks.md, speed).

/// Bytes read plus bytes written per second by memcpy between arrays far larger than caches.
/// @param threads  at once, each with arrays of its own   @param mebibytes  of each array
double copyRate(int threads, size_t mebibytes);
/// Float32 operations per second of fused multiply-adds in registers (two operations each) on the best instruction set.
/// @param threads  at once   @param seconds  of measurement
double fmaRate(int threads, double seconds);
std::string fmaTarget();  ///< the instruction set of fmaRate()

/// Does something, each time to its end, for 0.4 s: a GPU that was idle takes some tenths of a second to its full
/// clock.
void warmUpGpu(const std::function<void()>& work);
/// The same on the renderer of the current context: copies between buffers, multiply-adds in a compute shader.
double gpuCopyRate(size_t mebibytes);  ///< of each buffer, or as much as the driver lets a storage block be
double gpuFmaRate(double seconds);

/// Memory of this process that is resident [bytes].
double residentBytes();
int processors();

}  // namespace viscera::bench
