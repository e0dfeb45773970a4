// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

/// Measures one GPU: tuning options of kernels (sizes of work groups, with equal states for all of them; ways to read
/// neighbours), the share of its limits that they reach, large surface meshes, read-back, memory (docs/gpu.md).
void gpuSuite(Report& report, gpu::Context& context);

}  // namespace viscera::bench
