// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

/// Measures VR05 figure 11 by its method: images of a heart in which a blade cuts a growing incision.
void measureIncision(Report& report, gpu::Context& context);

}  // namespace viscera::bench
