// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

/// What kernels may be tuned by on one GPU: sizes of work groups, with equal states for all of them, and the ways in
/// which neighbours are read (docs/gpu.md).
void gpuSuite(Report& report, gpu::Context& context);

}  // namespace viscera::bench
