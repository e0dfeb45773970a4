// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

/// One GPU: what kernels may be tuned by (sizes of work groups, with equal states for all of them; ways in which
/// neighbours are read), what share of its limits they reach, large skins, read-back, memory (docs/gpu.md).
void gpuSuite(Report& report, gpu::Context& context);

}  // namespace viscera::bench
