// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Runs random strokes of a blade that tissue resists; measures the energy returned to the user, trips and non-finite
/// values.
void bladeStrokes(Report& report);

}  // namespace viscera::bench
