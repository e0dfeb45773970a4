// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

/// VR05 figure 11 as they did it: pictures of a heart in which a blade draws a longer and longer incision.
void measureIncision(Report& report, gpu::Context& context);

}  // namespace viscera::bench
