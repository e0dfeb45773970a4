// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Random strokes of a blade that tissue resists: what goes back to a hand, trips, what is not finite.
void bladeStrokes(Report& report);

}  // namespace viscera::bench
